// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/character.h"
#include "core/constraint.h"
#include "retarget/constraint_error.h"

namespace marey::retarget {

/// Whether the character has this point, and the offset is a number.
[[nodiscard]] Refusal check_point(const Constraint& constraint,
                                  const BodyPoint& point,
                                  const Skeleton& skeleton);

/// What is wrong with the goal alone, and with those constraints that it names; not with
/// circles of them. Precondition: the constraint's own point was checked.
[[nodiscard]] Refusal check_goal(const Constraint& constraint,
                                 const ConstraintSet& set,
                                 const Character& character);

}  // namespace marey::retarget
