// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/tag_visibility.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "calib/model/expected_error.h"
#include "core/detection.h"

namespace marey::calib {

TagCorners corners_in_world(const RigidTransform& world_from_tag, double size_m) {
  TagCorners out{};
  for (int c = 0; c < 4; ++c) {
    out[static_cast<std::size_t>(c)] = world_from_tag * corner_in_tag(c, size_m);
  }
  return out;
}

std::optional<double> visible_side_px(const Camera& camera,
                                      const RigidTransform& world_from_tag,
                                      const TagCorners& corners,
                                      const PlanOptions& options) {
  const glm::dvec3 sight = world_from_tag.translation - centre_in_world(camera);
  const glm::dvec3 into_tag = world_from_tag.rotation * glm::dvec3(0.0, 0.0, 1.0);
  const double facing = glm::dot(sight, into_tag) / glm::length(sight);
  if (!(facing > std::cos(options.max_angle_rad))) return std::nullopt;
  std::array<glm::dvec2, 4> pixels{};
  for (std::size_t c = 0; c < 4; ++c) {
    if (cameras_that_see(std::span(&camera, 1), corners[c]).empty()) return std::nullopt;
    pixels[c] = *project(camera, corners[c]);
  }
  double around_px = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    const double edge_px = glm::distance(pixels[c], pixels[(c + 1) % 4]);
    if (edge_px < options.min_side_px) return std::nullopt;
    around_px += edge_px;
  }
  return 0.25 * around_px;
}

}  // namespace marey::calib
