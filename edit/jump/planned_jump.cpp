// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/jump/planned_jump.h"

#include <string>
#include <utility>

#include "dynamics/jumps/find_jumps.h"
#include "dynamics/jumps/jump_wish.h"
#include "edit/state/resolve_moment.h"

#include "core/base/format_text.h"
#include "retarget/body/body_track.h"
#include "retarget/body/place_masses.h"

namespace marey::edit {
namespace {

/// Legs of an adult.
constexpr double kAdultLeg_m = 0.9;

dynamics::FindJumpsOptions find_options(const EditState& state) {
  dynamics::FindJumpsOptions out;
  const double size = state.map.leg_length_m / kAdultLeg_m;
  if (size < 1.0 / dynamics::kCaptureGravityFactor ||
      size > dynamics::kCaptureGravityFactor) {
    out.expected_fall_m_s2 = dynamics::kStandardGravity_m_s2 * size;
  }
  return out;
}

dynamics::JumpWish wish_of(const JumpOp& op) {
  dynamics::JumpWish out;
  out.apex_m = op.apex_m;
  out.apex_by_m = op.apex_by_m;
  out.airtime_s = op.airtime_s;
  out.length_m = op.length_m;
  out.landing_in_world = op.landing_in_world;
  out.box_m = op.box_m;
  out.push_s = op.push_s;
  return out;
}

}  // namespace

Result<FoundJumps> find_state_jumps(const JumpOp& op,
                                    const OpContext& context,
                                    const EditState& state) {
  const auto span = resolve_span(state, context.op.span);
  if (!span) return span.error();
  FoundJumps out;
  auto masses = masses_of(context, state);
  if (!masses) return masses.error();
  out.masses = std::move(*masses);
  out.track = retarget::body_track(state.motion, state.map, out.masses);
  dynamics::FindJumpsOptions options = find_options(state);
  if (op.push_start) {
    const auto frame = resolve_moment(state, *op.push_start);
    if (!frame) {
      Error error = frame.error();
      error.where = "push_start";
      return error;
    }
    options.start_s = *frame / state.motion.rate.hz;
  }
  const double hz = state.motion.rate.hz;
  for (dynamics::Jump& jump : dynamics::find_jumps(out.track, options)) {
    const double frame = jump.takeoff.time_s * hz;
    if (frame < span->first || frame > span->last) continue;
    out.jumps.push_back(std::move(jump));
  }
  if (out.jumps.empty()) {
    return bad_input(
        "jump",
        context.op.span.is_whole()
            ? "the motion has no time in which nothing bears the body after a support"
            : "the span has no time in which nothing bears the body after a support",
        "choose a motion, or a span, with a flight of at least 0.05 s");
  }
  if (op.jump < 1 || static_cast<std::size_t>(op.jump) > out.jumps.size()) {
    const std::string count = std::to_string(out.jumps.size());
    return bad_input(
        "jump",
        "jump " + std::to_string(op.jump) + " does not exist, there " +
            (out.jumps.size() == 1 ? "is 1 jump" : "are " + count + " jumps"),
        out.jumps.size() == 1 ? "choose 1" : "choose 1 to " + count);
  }
  out.chosen = static_cast<std::size_t>(op.jump - 1);
  const dynamics::Jump& chosen = out.jumps[out.chosen];
  if (op.push_start && chosen.start_kind != dynamics::PushStart::kGiven) {
    return bad_input("push_start",
                     "is not in the support before the take-off at " +
                         format_text("%.3f s", chosen.takeoff.time_s),
                     "choose an earlier instant, after the flight before");
  }
  return out;
}

dynamics::PlanJumpOptions plan_options(const JumpOp& op, FrameRate rate) {
  dynamics::PlanJumpOptions out;
  out.gravity_m_s2 = op.gravity_m_s2;
  out.law = op.law == EditPushLaw::kThesis ? dynamics::PushLawKind::kThesis
                                           : dynamics::PushLawKind::kForce;
  if (op.lowest) out.lowest = dynamics::LowestPoint{op.lowest->at, op.lowest->height_m};
  out.ballistic = op.ballistic;
  out.grid_s = 1.0 / rate.hz;
  return out;
}

Result<std::unique_ptr<dynamics::JumpReference>> jump_reference(const FoundJumps& found) {
  auto made = dynamics::JumpReference::make(found.track, found.jumps[found.chosen]);
  if (!made) {
    return bad_input("jump",
                     "has a captured push that does not lead to its take-off",
                     "state push_start, or filter the motion before");
  }
  return std::make_unique<dynamics::JumpReference>(std::move(*made));
}

Result<dynamics::JumpPlan> plan_of_op(const JumpOp& op,
                                      const dynamics::JumpReference& reference,
                                      FrameRate rate) {
  dynamics::JumpTraits traits;
  traits.strength_g = op.strength_g;
  return dynamics::plan_jump(reference, wish_of(op), traits, plan_options(op, rate));
}

}  // namespace marey::edit
