// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/character.h"
#include "core/constraint.h"
#include "retarget/constraints/constraint_error.h"

namespace marey::retarget {

/// Checks that the character has this point and that the offset is finite.
[[nodiscard]] OptionalError check_point(const Constraint& constraint,
                                        const BodyPoint& point,
                                        const Skeleton& skeleton);

/// Checks the goal and the constraints that it names, but not cycles of them.
/// Precondition: the constraint's own point was checked.
[[nodiscard]] OptionalError check_goal(const Constraint& constraint,
                                       const ConstraintSet& set,
                                       const Character& character);

}  // namespace marey::retarget
