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

/// VRM's name for what S4DMaker calls a segment; any other name as it is.
[[nodiscard]] std::string vrm_segment(std::string_view name);

/// As it is when unit to the last digits, else divided by its length: twice is once.
/// Precondition: not zero.
[[nodiscard]] glm::dquat made_unit(const glm::dquat& rotation);

}  // namespace marey::recordings
