// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/triangulate.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace marey::reconstruct {

std::optional<TriangulatedPoint> triangulate(std::span<const PointView> views,
                                             const TriangulateOptions& options) {
  if (views.size() < 2) return std::nullopt;
  glm::dmat3 normal(0.0);
  glm::dvec3 right(0.0);
  glm::dvec3 first(0.0);
  double max_rad = 0.0;
  for (const PointView& view : views) {
    const auto ray = unproject(view.camera->intrinsics, view.pixel_px);
    if (!ray) return std::nullopt;
    const RigidTransform world_from_camera = inverse(view.camera->camera_from_world);
    const glm::dvec3 d =
        glm::normalize(world_from_camera.rotation * glm::dvec3(*ray, 1.0));
    if (&view == views.data()) first = d;
    max_rad = std::max(max_rad, std::acos(std::clamp(glm::dot(first, d), -1.0, 1.0)));
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(d, d);
    normal += across;
    right += across * world_from_camera.translation;
  }
  if (max_rad < options.min_ray_angle_rad) return std::nullopt;
  TriangulatedPoint point{glm::inverse(normal) * right, 0.0};
  double sum = 0.0;
  for (const PointView& view : views) {
    const auto pixel = project(*view.camera, point.p_in_world);
    if (!pixel) return std::nullopt;
    const glm::dvec2 miss = *pixel - view.pixel_px;
    sum += glm::dot(miss, miss);
  }
  point.rms_px = std::sqrt(sum / static_cast<double>(views.size()));
  return point;
}

}  // namespace marey::reconstruct
