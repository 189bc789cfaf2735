// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dynamics/jumps/jump_reference.h"
#include "dynamics/jumps/plan_jump.h"
#include "dynamics/momentum/repair_flight.h"
#include "edit/state/op_report.h"

#include "core/base/time.h"
#include "retarget/com/follow_com.h"

namespace marey::edit {

/// Adds the figures of a planned jump and the findings of capture and plan.
void report_jump_plan(const dynamics::JumpReference& reference,
                      const dynamics::JumpPlan& plan,
                      OpReport& report);

/// Adds the figures of the body that followed the plan, and findings where it could not.
void report_jump_body(const retarget::FollowComReport& body,
                      FrameRate rate,
                      OpReport& report);

/// Adds the figures of the angular momentum in flight, and a finding if it was not
/// repaired.
void report_jump_momentum(const dynamics::MomentumRepair& repair, OpReport& report);

}  // namespace marey::edit
