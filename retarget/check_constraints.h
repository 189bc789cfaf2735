// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/character.h"
#include "core/constraint.h"
#include "core/ids.h"
#include "core/result.h"
#include "core/skeleton.h"

namespace marey::retarget {

/// The joint of the segment called `name`: the one that is VRM's bone of this name, else
/// the one that is itself called so. Linear in joints.
[[nodiscard]] std::optional<JointIndex> resolve_segment(const Skeleton& skeleton,
                                                        std::string_view name);

/// Maximum numbers of constraints in one set, and active at one time, ramps included.
inline constexpr std::size_t kMaxConstraints = 1000;
inline constexpr int kMaxActiveConstraints = 64;

/// Whether a character can be adapted to these constraints: done, or the first mistake.
///
/// Errors (kBadInput) name the constraint and say what to do:
/// - an id that is empty, or another's;
/// - more constraints than kMaxConstraints, or than kMaxActiveConstraints at one time; a
///   constraint that a caller starts (start from 1e8 s on) counts as active at none;
/// - numbers that are not finite; lengths beyond 10 km, times beyond 1e9 s, an importance
///   outside 1e-6 to 1e6 (single precision must hold their squares);
/// - precision, distance or durations below 0, a range below 1, stop before start;
/// - a segment that the character does not have (the nearest word is offered);
/// - a distance to a constraint that does not exist, to itself, or in a circle; to a
///   point of the same segment, which no posture changes;
/// - a rotation that is not unit, a box whose min is above its max;
/// - a support that is not the extremity of a limb of a group that can support;
/// - what no posture meets while both are fully active (cross-fading is not refused):
///   of one and the same point allowed boxes that have no point in common, one that lies
///   inside a forbidden box, supports with two footprints, a footprint outside an allowed
///   box or inside a forbidden one; of one foot footprints that are not as far apart as
///   the points that stand on them; two distances between the same two points. The last
///   four by more than both precisions; a support that starts only when a caller says so
///   (from 1e8 s on) may be placed by then, too, and is not looked at.
///
/// Precondition: the character is one that check_character() accepts. Linear in
/// constraints times joints, quadratic in boxes, supports and distances within the body.
[[nodiscard]] Status check_constraints(const ConstraintSet& constraints,
                                       const Character& character);

}  // namespace marey::retarget
