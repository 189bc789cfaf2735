// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/jump/jump_graph.h"

#include <cmath>
#include <cstddef>

#include "edit/jump/planned_jump.h"

namespace marey::edit {
namespace {

/// Curves have at most this many points.
constexpr double kMostPoints = 600.0;
/// Time shown before and after the jump. [s]
constexpr double kShownAround_s = 0.15;

void add_captured(const dynamics::JumpReference& reference,
                  double time_s,
                  JumpGraph& graph) {
  graph.captured_height_m.push_back(reference.captured(time_s).y);
  graph.captured_push_g.push_back(reference.captured_push_g(time_s));
}

/// Without a plan: the captured curves at their own times.
void draw_captured(const dynamics::JumpReference& reference,
                   double step_s,
                   JumpGraph& graph) {
  const double from_s = std::max(0.0, reference.jump().start.time_s - kShownAround_s);
  const double to_s =
      std::min(reference.end_s(), reference.jump_end_s() + kShownAround_s);
  for (double time_s = from_s; time_s <= to_s; time_s += step_s) {
    graph.time_s.push_back(time_s);
    add_captured(reference, time_s, graph);
  }
}

void draw_plan(const dynamics::JumpReference& reference,
               const dynamics::JumpPlan& plan,
               double step_s,
               JumpGraph& graph) {
  graph.start_s = plan.start_s();
  graph.lowest_s = plan.lowest_s();
  graph.takeoff_s = plan.takeoff().time_s;
  graph.apex_s = plan.apex_s();
  const double last_s = reference.end_s() + plan.delay_s();
  graph.landing_s = plan.touchdown() ? plan.touchdown()->time_s : last_s;
  graph.end_s = plan.rest() ? plan.rest()->time_s : last_s;
  const double from_s = std::max(0.0, plan.start_s() - kShownAround_s);
  const double to_s = std::min(last_s, graph.end_s + kShownAround_s);
  for (double time_s = from_s; time_s <= to_s; time_s += step_s) {
    graph.time_s.push_back(time_s);
    graph.height_m.push_back(plan.com_in_world(time_s).y);
    graph.push_g.push_back(plan.push_g(time_s));
    add_captured(reference, plan.source_s(time_s), graph);
  }
}

/// Returns the ends of the push that a plan asks for, or those of the captured one.
dynamics::PushEnds ends_of_push(const dynamics::JumpReference& reference,
                                const dynamics::JumpPlan* plan) {
  const dynamics::SupportReference& push = reference.push();
  const dynamics::ComState end = plan != nullptr ? plan->takeoff() : push.end;
  const double gravity_m_s2 = plan != nullptr ? plan->gravity_m_s2() : push.gravity_m_s2;
  dynamics::SupportWish wish;
  wish.start = push.start;
  wish.end = end;
  wish.gravity_m_s2 = gravity_m_s2;
  return dynamics::thesis_ends(push, wish);
}

}  // namespace

Result<JumpGraph> jump_graph(const JumpOp& op,
                             const OpContext& context,
                             const EditState& state) {
  JumpGraph out;
  const auto found = find_state_jumps(op, context, state);
  if (!found) {
    // The list of jumps helps to choose another number or start.
    JumpOp any = op;
    any.jump = 1;
    any.push_start.reset();
    const auto others = find_state_jumps(any, context, state);
    if (!others) return others.error();
    out.jumps = others->jumps;
    out.refusal = found.error().message();
    return out;
  }
  out.jumps = found->jumps;
  const auto reference = jump_reference(*found);
  if (!reference) {
    out.refusal = reference.error().message();
    return out;
  }
  const double shown_s = (*reference)->jump_end_s() + 2.0 * kShownAround_s -
                         (*reference)->jump().start.time_s;
  const double step_s = std::max(1.0 / state.motion.rate.hz, shown_s / kMostPoints);
  out.strength_g = op.strength_g.value_or((*reference)->strength_g());
  const auto plan = plan_of_op(op, **reference, state.motion.rate);
  if (!plan) {
    out.refusal = plan.error().message();
    draw_captured(**reference, step_s, out);
  } else {
    draw_plan(**reference, *plan, step_s, out);
  }
  if (op.law == EditPushLaw::kThesis) {
    out.space =
        dynamics::search_space(ends_of_push(**reference, plan ? &*plan : nullptr));
    const dynamics::LowestPoint lowest =
        plan ? plan->push().lowest() : (*reference)->push_model().lowest();
    out.space_lowest_at = lowest.at;
    out.space_lowest_m = lowest.height_m;
  }
  return out;
}

}  // namespace marey::edit
