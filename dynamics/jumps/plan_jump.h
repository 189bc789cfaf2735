// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dynamics/jumps/jump_plan.h"
#include "dynamics/jumps/jump_reference.h"
#include "dynamics/jumps/jump_wish.h"

#include "core/base/result.h"

namespace marey::dynamics {

/// Turns wishes into a plan (docs/jumps.md; Kulpa 2005, 6.2 to 6.4, with its error in
/// 6.2.1 corrected). Everything else keeps the captured value: rise, horizontal velocity,
/// durations of push and landing.
///
/// The captured residual stays in push and landing. In flight it fades out as the wish
/// departs from the captured jump (gone at 30 mm or four times the residual), so that a
/// changed flight is a parabola exactly, and a jump without changes is the captured one.
/// Some ten microseconds with the force law.
///
/// Errors (bad input), each with the possible range: wishes that contradict each other;
/// an apex at or below the take-off; a landing that the flight does not reach; a push
/// beyond the strength, or that no force makes; a wish on the landing of a clip that ends
/// before it; numbers that are not finite.
[[nodiscard]] Result<JumpPlan> plan_jump(const JumpReference& reference,
                                         const JumpWish& wish,
                                         const JumpTraits& traits = {},
                                         const PlanJumpOptions& options = {});

/// The plan would outlive a temporary reference.
Result<JumpPlan> plan_jump(const JumpReference&&,
                           const JumpWish&,
                           const JumpTraits& = {},
                           const PlanJumpOptions& = {}) = delete;

}  // namespace marey::dynamics
