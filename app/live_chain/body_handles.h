// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/constraint.h"
#include "core/skeleton.h"

namespace marey::app {

/// A joint at which a user can drag a body.
struct BodyHandle {
  std::string_view id;       ///< "left hand".
  std::string_view segment;  ///< VRM's name: "leftHand".
  JointIndex joint{};
};

/// Start time of a constraint that only the caller activates: later than any motion. [s]
inline constexpr double kNotByItself_s = 1e9;

/// Returns the handles of head, hands, feet and hips, in this order, without handles that
/// the body lacks. The hips are always present. Linear in the number of joints.
[[nodiscard]] std::vector<BodyHandle> body_handles(const Skeleton& skeleton);

/// Returns a constraint that moves the joint to the target of its handle. It is inactive
/// until the caller activates it, and fades in and out over `fade_s`.
[[nodiscard]] Constraint handle_constraint(const BodyHandle& handle, double fade_s);

/// Returns the support constraints of the feet, "leftFoot" and "rightFoot", without feet
/// that the body lacks. They are inactive until the caller activates them, and fade in
/// and out over `fade_s`.
[[nodiscard]] std::vector<Constraint> foot_supports(const Skeleton& skeleton,
                                                    double fade_s);

}  // namespace marey::app
