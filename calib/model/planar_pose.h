// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: poses of planes and points relative to one camera of known
// intrinsics.

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/camera.h"
#include "core/transform.h"

namespace marey::calib {

/// Rounds an estimate of OpenCV to single precision. OpenCV's solvers call the installed
/// BLAS, whose last bits depend on memory alignment; without rounding, so would all
/// results that start from the estimate.
[[nodiscard]] inline double to_single_precision(double guess) {
  return static_cast<float>(guess);
}

/// A pose of a plane that fits its pixels.
struct PlacedPlane {
  RigidTransform camera_from_plane;
  double misfit = 0.0;  ///< Root mean square at z = 1: pixels over focal length.
};

/// Returns the one or two poses of a plane's points (z = 0 of their frame) that fit their
/// pixels, the better first (Collins & Bartoli 2014, IPPE, refined). The tilt of a
/// distant tag towards the camera is hard to distinguish from the same tilt away from it.
/// Returns no pose if fewer than four points are seen, or if the plane would be behind
/// the camera.
[[nodiscard]] std::vector<PlacedPlane> place_plane(const Intrinsics& intrinsics,
                                                   std::span<const glm::dvec3> p_in_plane,
                                                   std::span<const glm::dvec2> pixels_px);

/// Returns the camera's pose from seen points of known positions, robustly (four of every
/// six may be outliers). Returns nullopt if fewer than six points agree. Deterministic.
[[nodiscard]] std::optional<RigidTransform> resect(const Intrinsics& intrinsics,
                                                   std::span<const glm::dvec3> p_in_world,
                                                   std::span<const glm::dvec2> pixels_px);

/// Returns the point nearest to all rays of cameras of known poses: linear, no
/// refinement. Returns nullopt for fewer than two rays, or if all are parallel.
[[nodiscard]] std::optional<glm::dvec3> nearest_to_rays(
    std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions);

}  // namespace marey::calib
