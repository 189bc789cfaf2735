// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/jump/apply_jump.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/momentum/ballistic.h"
#include "dynamics/momentum/repair_flight.h"
#include "edit/jump/jump_feet.h"
#include "edit/jump/planned_jump.h"
#include "edit/jump/report_jump.h"
#include "edit/state/check_op_keys.h"
#include "edit/state/move_state.h"
#include "edit/state/resample_state.h"
#include <glm/vec3.hpp>

#include "retarget/com/follow_com.h"

namespace marey::edit {
namespace {

/// An instant this near to a frame is the frame's. [frames]
constexpr double kOnFrame = 1e-6;

/// Returns the frames of the motion that appear at the frames of the new one.
std::vector<double> shown_frames(const EditState& state, const dynamics::JumpPlan& plan) {
  const double hz = state.motion.rate.hz;
  const double last = state.frame_count() - 1;
  const auto count =
      static_cast<std::size_t>(std::floor(last + plan.delay_s() * hz + kOnFrame)) + 1;
  std::vector<double> out;
  out.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    double at = plan.source_s(static_cast<double>(k) / hz) * hz;
    const double nearest = std::round(at);
    if (std::abs(at - nearest) < kOnFrame) at = nearest;
    at = std::min(at, last);
    if (!out.empty() && at <= out.back()) break;
    out.push_back(at);
  }
  return out;
}

/// Makes the body follow the plan. `state` shows the captured postures at their new
/// times.
retarget::FollowComReport follow_plan(const FoundJumps& found,
                                      const dynamics::JumpPlan& plan,
                                      const EditState& captured,
                                      std::span<const double> frames,
                                      EditState& state) {
  const auto feet = jump_feet(captured, frames, state, plan);
  const double hz = state.motion.rate.hz;
  std::vector<glm::dvec3> com(state.motion.poses.size());
  for (std::size_t k = 0; k < com.size(); ++k) {
    com[k] = plan.com_in_world(static_cast<double>(k) / hz);
  }
  const std::vector<Pose> shown = state.motion.poses;
  return retarget::follow_com(
      {state.motion.skeleton, state.map, found.masses, state.motion.rate},
      {shown, com, {feet[0], feet[1]}},
      state.motion.poses);
}

std::optional<FrameRange> flight_of(const dynamics::JumpPlan& plan,
                                    const EditState& state) {
  if (!plan.touchdown()) return std::nullopt;
  return dynamics::flight_frames(plan.takeoff().time_s,
                                 plan.touchdown()->time_s,
                                 state.motion.rate,
                                 state.motion.poses.size());
}

/// Makes the angular momentum of a flight constant.
dynamics::MomentumRepair repaired(const FoundJumps& found,
                                  const FrameRange& flight,
                                  Motion& motion) {
  const auto count = static_cast<std::size_t>(flight.last - flight.first + 1);
  return dynamics::keep_angular_momentum(
      motion.skeleton,
      found.masses,
      motion.rate,
      std::span(motion.poses).subspan(static_cast<std::size_t>(flight.first), count));
}

/// Returns the standard deviation of the captured flight's angular momentum.
double captured_momentum_sd(const FoundJumps& found, const Motion& captured) {
  const dynamics::Jump& jump = found.jumps[found.chosen];
  const auto flight = dynamics::flight_frames(
      jump.takeoff.time_s, jump.touchdown->time_s, captured.rate, captured.poses.size());
  if (!flight) return 0.0;
  Motion copy = captured;
  return repaired(found, *flight, copy).sd_before_kg_m2_s;
}

/// Displaces the constraints that act after the landing.
void move_landed_constraints(const dynamics::JumpPlan& plan, EditState& state) {
  if (!plan.touchdown()) return;
  const double duration_s = state.duration_s();
  for (Constraint& constraint : state.constraints.constraints) {
    const Activation& active = constraint.activation;
    const double from_s = std::clamp(active.start_s.value_or(0.0), 0.0, duration_s);
    const double to_s = std::clamp(active.stop_s.value_or(duration_s), 0.0, duration_s);
    if (0.5 * (from_s + to_s) < plan.touchdown()->time_s) continue;
    move_constraint({glm::dquat(1.0, 0.0, 0.0, 0.0), plan.landing_moved_m()}, constraint);
  }
}

void add_phases(const dynamics::JumpPlan& plan, EditState& state) {
  const auto add = [&](const char* text, double start_s, double end_s) {
    const double end = state.duration_s();
    if (start_s >= end) return;
    state.annotations.notes.push_back({text, start_s, std::min(end_s, end)});
  };
  const double takeoff_s = plan.takeoff().time_s;
  add("phase:push", std::max(0.0, plan.start_s()), takeoff_s);
  const double landing_s =
      plan.touchdown() ? plan.touchdown()->time_s : state.duration_s();
  add("phase:flight", takeoff_s, landing_s);
  if (plan.rest()) add("phase:landing", landing_s, plan.rest()->time_s);
  std::stable_sort(state.annotations.notes.begin(),
                   state.annotations.notes.end(),
                   [](const Annotation& a, const Annotation& b) {
                     return a.start_s != b.start_s ? a.start_s < b.start_s
                                                   : a.text < b.text;
                   });
}

}  // namespace

Result<EditState> apply_jump(const JumpOp& op,
                             const OpContext& context,
                             const EditState& state,
                             OpReport& report) {
  if (const Status ok = check_op_keys(context.op, {.span = true}); !ok) {
    return ok.error();
  }
  const auto found = find_state_jumps(op, context, state);
  if (!found) return found.error();
  const auto reference = jump_reference(*found);
  if (!reference) return reference.error();
  const auto plan = plan_of_op(op, **reference, state.motion.rate);
  if (!plan) return plan.error();
  report_jump_plan(**reference, *plan, report);
  if (plan->is_identity()) {
    EditState out = state;
    add_phases(*plan, out);
    report_jump_body({}, state.motion.rate, report);
    return out;
  }
  const std::vector<double> frames = shown_frames(state, *plan);
  EditState out = resample_state(state, frames, state.motion.rate.hz);
  const Motion shown = out.motion;
  const retarget::FollowComReport body = follow_plan(*found, *plan, state, frames, out);
  report_jump_body(body, state.motion.rate, report);
  if (const auto flight = flight_of(*plan, out); flight && op.keep_momentum) {
    dynamics::MomentumRepair repair = repaired(*found, *flight, out.motion);
    repair.sd_before_kg_m2_s = captured_momentum_sd(*found, state.motion);
    report_jump_momentum(repair, report);
  }
  move_landed_constraints(*plan, out);
  add_phases(*plan, out);
  const int first = std::clamp(
      static_cast<int>(plan->start_s() * out.motion.rate.hz), 0, out.frame_count() - 1);
  report.figures.emplace_back(
      "displaced_mm",
      1e3 * mark_displaced(
                out, shown, {first, out.frame_count() - 1}, context.index, true));
  return out;
}

}  // namespace marey::edit
