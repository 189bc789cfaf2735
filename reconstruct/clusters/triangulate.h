// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/camera.h"

namespace marey::reconstruct {

/// One camera's observation of one point.
struct PointView {
  const Camera* camera = nullptr;  ///< Borrowed; must outlive the call.
  glm::dvec2 pixel_px{0.0};        ///< As observed, distorted.
};

struct TriangulatedPoint {
  glm::dvec3 p_in_world{0.0};  ///< [m]
  double rms_px = 0.0;         ///< Reprojection distance over the views.
};

struct TriangulateOptions {
  /// Rays closer than this to parallel give no usable depth. [rad]
  double min_ray_angle_rad = 0.03;
};

/// Computes the point nearest to all viewing rays (least squares of distances).
/// nullopt if the geometry does not determine it: fewer than two views, rays nearly
/// parallel, the point behind a camera, or a pixel without a ray. Pure; linear in views.
[[nodiscard]] std::optional<TriangulatedPoint> triangulate(
    std::span<const PointView> views, const TriangulateOptions& options = {});

}  // namespace marey::reconstruct
