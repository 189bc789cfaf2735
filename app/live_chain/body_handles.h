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

/// Where a body can be taken hold of: at a joint.
struct BodyHandle {
  std::string_view id;  ///< "left hand".
  std::string_view segment;  ///< VRM's name: "leftHand".
  JointIndex joint{};
};

/// From when on a constraint holds of which only a caller says when: never by itself. [s]
inline constexpr double kNotByItself_s = 1e9;

/// Head, hands, feet and hips, in this order, as far as the body has them: always the
/// hips. Linear in joints.
[[nodiscard]] std::vector<BodyHandle> body_handles(const Skeleton& skeleton);

/// The joint is to be at a place that its handle sets. Does not hold by itself; fades in
/// and out over `fade_s`.
[[nodiscard]] Constraint handle_constraint(const BodyHandle& handle, double fade_s);

/// A foot that stands, "leftFoot" or "rightFoot", likewise. None of a body without it.
[[nodiscard]] std::vector<Constraint> foot_supports(const Skeleton& skeleton,
                                                    double fade_s);

}  // namespace marey::app
