// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/camera.h"
#include "core/transform.h"

namespace marey::testing {

/// The corners of a tag in one camera.
struct TagView {
  const Camera* camera = nullptr;
  std::array<glm::dvec2, 4> corners_px{};  ///< In TagDetection's order.
  double sigma_px = 0.1;
};

/// The rigid pose of a tag that fits all views best, near `world_from_tag`: a few steps
/// of Gauss-Newton, without any robustness. Precondition: the views determine it.
[[nodiscard]] RigidTransform fit_tag_pose(std::span<const TagView> views,
                                          double size_m,
                                          RigidTransform world_from_tag);

}  // namespace marey::testing
