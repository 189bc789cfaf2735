// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/constraint.h"
#include "core/transform.h"

namespace marey::edit {

/// Moves what a constraint has in the world: points, rotations, and the centres of
/// spaces. Spaces keep their size and stay parallel to the world's axes. Returns false if
/// it is a space and the motion turns it by more than 1 degree: the result is then
/// another space.
bool move_constraint(const RigidTransform& moved_from_old, Constraint& constraint);

/// Returns the middle of the time in which a constraint is active, within a motion of
/// this duration. [s]
[[nodiscard]] double middle_s(const Constraint& constraint, double duration_s);

}  // namespace marey::edit
