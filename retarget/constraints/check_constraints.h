// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/base/result.h"
#include "core/character.h"
#include "core/constraint.h"

namespace marey::retarget {

/// Maximum numbers of constraints in one set, and active at one time, ramps included.
inline constexpr std::size_t kMaxConstraints = 1000;
inline constexpr int kMaxActiveConstraints = 64;

/// Checks that a character can be adapted to these constraints. Returns the first error.
///
/// Errors (kBadInput) name the constraint and the next step:
/// - an empty or duplicate id;
/// - more constraints than kMaxConstraints, or more than kMaxActiveConstraints active at
///   one time; a constraint that a caller starts (start of 1e8 s or later) does not count
///   as active;
/// - numbers that are not finite; lengths beyond 10 km, times beyond 1e9 s, an importance
///   outside 1e-6 to 1e6 (single precision must represent their squares);
/// - precision, distance or durations below 0, a range below 1, stop before start;
/// - an unknown segment (the nearest name is suggested);
/// - a distance to an unknown constraint, to itself, in a cycle, or to a point of the
///   same segment, which is constant;
/// - a rotation that is not unit, a box with min above max;
/// - a support that is not the extremity of a limb of a group that can support;
/// - contradictions between constraints that are both fully active at one time
///   (cross-fades are permitted). For one point: allowed boxes without a common point, an
///   allowed box inside a forbidden box, supports with two footprints, a footprint
///   outside an allowed box or inside a forbidden one. For one foot: footprints whose
///   distance differs from that of the points that stand on them. For two points: two
///   distances.
///   The tolerance for footprints and distances is the sum of both precisions. A support
///   with a start of 1e8 s or later is not checked, because a caller may place it.
///
/// Precondition: the character is one that check_character() accepts. Linear in
/// constraints times joints, quadratic in boxes, supports and distances within the body.
[[nodiscard]] Status check_constraints(const ConstraintSet& constraints,
                                       const Character& character);

}  // namespace marey::retarget
