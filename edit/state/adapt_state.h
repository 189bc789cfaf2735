// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/character.h"

namespace marey::edit {

/// Makes the character of a state's body, for constraints. Errors: those of
/// retarget::make_character().
[[nodiscard]] Result<Character> character_of(const EditState& state);

/// Adapts the motion to the state's constraints (Kulpa 2005, 4;
/// retarget::adapt_motion()), after its feet are planted (plant_feet()), so that legs
/// reach the footprints of the contacts. Supports fade along the moving foot
/// (split_supports()). Feet without a Support constraint stand where
/// retarget::plan_supports() plans them from the state's contacts. Contacts and
/// constraints stay as they are. Exception: a detected touch ("found ...") whose error
/// remains above 10 mm is removed, with a finding, and the motion is adapted again
/// without it, because it would pull the body. Without constraints nothing changes.
///
/// Frames without an active constraint whose joints would move by less than 0.02 mm (the
/// adapter's single precision) keep their pose to the bit. The others are touched in the
/// lineage, and marked where a joint moved by more than 10 mm (mark_displaced(), with
/// OpReport::index).
///
/// Figures: left_out (detected touches), constraints, unmet (number of constraints that
/// are not met in all frames in which they are fully active), error_mm.ID or error_deg.ID
/// (largest error of each constraint that is ever fully active), worst_constraint_mm,
/// slide_mm, added_acceleration_m_per_s2, displaced_mm. Findings: each unmet constraint;
/// one that is never fully active within the motion. Costs one adaptation per frame,
/// again for each round in which touches are left out.
///
/// Errors (bad input): those of character_of() and of
/// retarget::check_constraints(), which names the constraint. On an error the state is
/// unchanged.
[[nodiscard]] Status adapt_state(EditState& state, OpReport& report);

}  // namespace marey::edit
