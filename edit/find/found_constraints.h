// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "edit/state/constraint_copies.h"
#include "edit/state/edit_state.h"

#include "core/constraint.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Returns the given name without its number: "leftFoot flat".
[[nodiscard]] std::string_view family_name(std::string_view id);

/// Returns the supports that the state's contacts show (retarget::plan_supports(),
/// retarget::support_constraints()): one constraint per stance and kind of contact (flat,
/// heel, ball), with footprint, rotation, times since the first pose and fades. Edges of
/// contacts that were changed by hand are those of the state. Footprints are those of
/// plant_feet(), so that adaptation, which plants the feet first, adds nothing to them.
/// Costs frames times stances.
[[nodiscard]] std::vector<Constraint> found_supports(const EditState& state);

/// Returns the touches of the hands: on the own body (retarget::find_touches(), with the
/// volume of an average adult), at rest in the world while the shoulder moves
/// (DistanceToPoint), and on objects (find_box_touches()): the point of the hand's
/// surface stays on the nearest point of the object's surface. A hand on an object is not
/// reported as at rest in the world, too. A hand that touches several parts of the body
/// at once has the nearest only, because no posture may meet more. Fades last while the
/// hand is within 5 cm of the touch, from 0.1 to 0.3 s, at most half the pause to the
/// hand's neighbouring touches on objects. Linear in frames.
[[nodiscard]] std::vector<Constraint> found_touches(const EditState& state,
                                                    std::span<const EditObject> objects);

}  // namespace marey::edit
