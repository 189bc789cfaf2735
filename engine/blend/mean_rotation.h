// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/gtc/quaternion.hpp>

namespace marey::engine {

/// Returns the weighted mean of rotations: signs to the side of `side` (of the heaviest
/// rotation if nullptr), weighted sum, normalised, then two tangent steps: the mean of
/// the logarithms about it. Two rotations: slerp, exact. Within 0.01 degrees of the
/// intrinsic mean for rotations up to 120 degrees apart. The sum of the weights is
/// arbitrary. The scalar reference of blend_postures(). Precondition: as many weights as
/// rotations, at least one above 0; unit quaternions; weights >= 0.
[[nodiscard]] glm::dquat mean_rotation(std::span<const glm::dquat> rotations,
                                       std::span<const double> weights,
                                       const glm::dquat* side = nullptr);

}  // namespace marey::engine
