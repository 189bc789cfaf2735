// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/plan_jump.h"

#include "dynamics/jumps/jump_planner.h"

namespace marey::dynamics {

Result<JumpPlan> plan_jump(const JumpReference& reference,
                           const JumpWish& wish,
                           const JumpTraits& traits,
                           const PlanJumpOptions& options) {
  JumpPlanner planner(reference, wish, traits, options);
  return planner.plan();
}

}  // namespace marey::dynamics
