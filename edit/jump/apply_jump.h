// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/edit/edit_ops.h"

namespace marey::edit {

/// Makes one jump higher, longer, onto a box, or ballistic (docs/jumps.md; Kulpa 2005,
/// 6).
///
/// Finds the jumps of the span (dynamics::find_jumps()), plans the new course of the
/// centre of mass (dynamics::plan_jump()), shows the captured postures at new times,
/// and lets the body follow the plan with its feet on their places
/// (retarget::follow_com()). In flight the body turns about its centre of mass so that
/// its angular momentum is constant, unless `keep_momentum` is false. Everything after
/// the landing is displaced with it, by whole frames in time, and constraints with it.
/// Phases become annotations "phase:push", "phase:flight" and "phase:landing". Masses are
/// EditInputs::masses or de Leva's. A jump without wishes keeps its poses to the bit,
/// whatever its captured gravity.
///
/// Figures, each with the captured value as captured_NAME where there is one: start_s,
/// lowest_s, takeoff_s, apex_s, touchdown_s, rest_s, rise_m, airtime_s, takeoff_m_s,
/// length_m, lowest_m, push_g, momentum_kg_m2_s (standard deviation in flight);
/// captured_fall_m_s2, com_error_mm (in flight), com_error_push_mm, slide_mm,
/// raised_heel_mm, short_leg_mm, turn_deg, displaced_mm. Linear in frames.
///
/// Errors (bad input): groups and blend_s; those of find_state_jumps(), of
/// jump_reference() and of dynamics::plan_jump().
[[nodiscard]] Result<EditState> apply_jump(const JumpOp& op,
                                           const OpContext& context,
                                           const EditState& state,
                                           OpReport& report);

}  // namespace marey::edit
