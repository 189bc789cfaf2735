// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>

#include <glm/gtc/quaternion.hpp>

#include "core/constraint.h"

namespace marey::recordings {

/// The element of each type of constraint, in the order of Goal's alternatives.
inline constexpr std::array<std::string_view, std::variant_size_v<Goal>> kGoalElements{
    "Distance",
    "BodyDistance",
    "ConstraintDistance",
    "AllowedSpace",
    "ForbiddenSpace",
    "Orientation",
    "Support",
};

/// Returns VRM's name for a segment name of S4DMaker; any other name unchanged.
[[nodiscard]] std::string vrm_segment(std::string_view name);

/// Returns the rotation unchanged if it is a unit quaternion to the last digits, else
/// divided by its length. Idempotent. Precondition: not zero.
[[nodiscard]] glm::dquat normalized_once(const glm::dquat& rotation);

}  // namespace marey::recordings
