// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/edit_state.h"
#include <glm/vec3.hpp>

#include "core/constraint.h"
#include "core/transform.h"

namespace marey::edit {

/// Returns a turn about the vertical through a point, followed by a translation: `pivot`
/// goes to `target`.
[[nodiscard]] RigidTransform turn_about(const glm::dvec3& pivot_in_world,
                                        double turn_rad,
                                        const glm::dvec3& target_in_world);

/// Moves the world points and rotations of a constraint. A box stays along the world's
/// axes: an allowed space becomes the smallest box that holds the turned one, a forbidden
/// space keeps its size.
void move_constraint(const RigidTransform& new_from_old, Constraint& constraint);

/// Moves and turns the whole motion with its constraints, exactly as a rigid body.
/// Heights of the contacts move along. Precondition: the transform turns about the
/// vertical only if the contacts are used afterwards.
void move_state(const RigidTransform& new_from_old, EditState& state);

}  // namespace marey::edit
