// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/constraint.h"

namespace marey::edit {

/// Ids of detected constraints begin with this word, as in "found leftFoot flat 1". A
/// constraint that is changed by hand loses it, and a new detection keeps it.
inline constexpr std::string_view kFoundPrefix = "found ";

[[nodiscard]] inline bool is_found(std::string_view id) {
  return id.starts_with(kFoundPrefix);
}

/// Returns the id without the word of detected constraints.
[[nodiscard]] inline std::string_view given_name(std::string_view id) {
  return is_found(id) ? id.substr(kFoundPrefix.size()) : id;
}

/// Differences below which two goals are the same.
struct GoalTolerance {
  double place_m = 1e-9;
  /// One minus the cosine of half the angle between two rotations.
  double rotation = 1e-9;
};

/// Returns true if two goals have the same type, numbers and names. Places and rotations
/// may differ by the tolerance; distances and names must be equal.
[[nodiscard]] bool is_same_goal(const Goal& a,
                                const Goal& b,
                                const GoalTolerance& tolerance = {});

/// Returns true if two constraints are on the same point of the body.
[[nodiscard]] bool is_same_point(const BodyPoint& a, const BodyPoint& b);

/// Returns `id` if no constraint of the set has it; otherwise an id with the next free
/// number: "leftFoot flat 3" for "leftFoot flat 1", "grip.2" for an id without a number.
[[nodiscard]] std::string free_constraint_id(const ConstraintSet& set,
                                             std::string_view id);

}  // namespace marey::edit
