// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "dynamics/jumps/jump.h"
#include "dynamics/jumps/jump_reference.h"
#include "dynamics/jumps/plan_jump.h"
#include "edit/state/edit_state.h"
#include "edit/state/op_report.h"

#include "core/base/result.h"
#include "core/character.h"
#include "core/edit/edit_ops.h"
#include "core/human/body_track.h"

namespace marey::edit {

/// Jumps of a motion, and the one that an operation changes.
struct FoundJumps {
  std::vector<PointMass> masses;  ///< masses_of().
  BodyTrack track;
  std::vector<dynamics::Jump> jumps;  ///< All whose take-off is within the span.
  std::size_t chosen = 0;             ///< Index of JumpOp::jump.
};

/// Finds the jumps of a state. A body whose legs are much shorter or longer than an
/// adult's is expected to fall at the rate of a motion that was scaled to it. Linear in
/// frames.
/// Errors (bad input): no flight; fewer jumps than JumpOp::jump; those of place_masses()
/// and of resolve_span().
[[nodiscard]] Result<FoundJumps> find_state_jumps(const JumpOp& op,
                                                  const OpContext& context,
                                                  const EditState& state);

/// Returns the options of a plan for a motion at this rate.
[[nodiscard]] dynamics::PlanJumpOptions plan_options(const JumpOp& op, FrameRate rate);

/// Prepares the chosen jump. Error (bad input): its captured forces cannot be computed.
[[nodiscard]] Result<std::unique_ptr<dynamics::JumpReference>> jump_reference(
    const FoundJumps& found);

/// Plans the operation's wishes. `reference` must outlive the plan. Errors: those of
/// plan_jump().
[[nodiscard]] Result<dynamics::JumpPlan> plan_of_op(
    const JumpOp& op, const dynamics::JumpReference& reference, FrameRate rate);

}  // namespace marey::edit
