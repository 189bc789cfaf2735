// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: places of things before one camera of known intrinsics.

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/camera.h"
#include "core/transform.h"

namespace marey::calib {

/// A guess by OpenCV, to single precision: its solvers call whatever BLAS the machine has,
/// whose last bits follow where memory lies, and what starts there would too.
[[nodiscard]] inline double settled(double guess) {
  return static_cast<float>(guess);
}

/// A place that suits what the camera saw.
struct PlacedPlane {
  RigidTransform camera_from_plane;
  double misfit = 0.0;  ///< Root mean square at z = 1: pixels over focal length.
};

/// The one or two places of a plane's points (z = 0 of their frame) that suit their
/// pixels, the better first (Collins & Bartoli 2014, IPPE, refined): seen from afar, a
/// tag's tilt towards the camera looks much like the same tilt away from it. Empty where
/// fewer than four points are seen, or the plane would be behind the camera.
[[nodiscard]] std::vector<PlacedPlane> place_plane(const Intrinsics& intrinsics,
                                                   std::span<const glm::dvec3> p_in_plane,
                                                   std::span<const glm::dvec2> pixels_px);

/// Where a camera stands that sees these points there, robustly (four of every six may be
/// wrong). nullopt when fewer than six agree. Deterministic.
[[nodiscard]] std::optional<RigidTransform> resect(const Intrinsics& intrinsics,
                                                   std::span<const glm::dvec3> p_in_world,
                                                   std::span<const glm::dvec2> pixels_px);

/// The point nearest all rays, of cameras of known places: linear, no refinement. nullopt
/// when fewer than two rays, or all parallel.
[[nodiscard]] std::optional<glm::dvec3> nearest_to_rays(
    std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions);

}  // namespace marey::calib
