// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Whether a character can be adapted to these constraints: done, or the first mistake.
///
/// Errors (kBadInput) name the constraint and say what to do:
/// - an id that is empty, or another's;
/// - numbers that are not finite; lengths beyond 10 km, times beyond 1e9 s, an importance
///   outside 1e-6 to 1e6 (single precision must hold their squares);
/// - precision, distance or durations below 0, a range below 1, stop before start;
/// - a segment that the character does not have (the nearest word is offered);
/// - a distance to a constraint that does not exist, to itself, or in a circle; to a
///   point of the same segment, which no posture changes;
/// - a rotation that is not unit, a box whose min is above its max;
/// - a support that is not the extremity of a limb of a group that can support;
/// - of one and the same point, while both are fully active (cross-fading is not
/// refused):
///   allowed boxes that have no point in common, one that lies inside a forbidden box,
///   supports with two footprints.
///
/// Precondition: the character is one that check_character() accepts. Linear in
/// constraints times joints, quadratic in boxes, supports and distances to constraints.
[[nodiscard]] Status check_constraints(const ConstraintSet& constraints,
                                       const Character& character);

}  // namespace marey::retarget
