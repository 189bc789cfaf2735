// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: visibility of a tag in a planned camera.

#include <array>
#include <optional>

#include "calib/plan/plan_options.h"
#include "core/camera.h"
#include "core/transform.h"

namespace marey::calib {

/// Corners in the world, in TagDetection's order.
using TagCorners = std::array<glm::dvec3, 4>;

[[nodiscard]] TagCorners corners_in_world(const RigidTransform& world_from_tag,
                                          double size_m);

/// Returns the mean side [px] of a tag in a camera that sees it; nullopt if it is turned
/// away, partly outside the image or too small. `options.tag_size_m` is not used.
[[nodiscard]] std::optional<double> visible_side_px(const Camera& camera,
                                                    const RigidTransform& world_from_tag,
                                                    const TagCorners& corners,
                                                    const PlanOptions& options);

}  // namespace marey::calib
