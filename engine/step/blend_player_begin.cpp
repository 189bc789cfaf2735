// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/step/blend_player.h"
#include "engine/sync/plan_sync.h"
#include "engine/transition/entry_cost.h"
#include "engine/transition/landing_cost.h"

// The beginning of actions, and the transitions to them.

namespace marey::engine {
namespace {

// A clip that does not loop is not entered so late that it ends within this time.
constexpr double kLeast_s = 1.2;
// A fade begins at most this late. [s]
constexpr double kMostDelay_s = 0.12;

}  // namespace

BlendPlayer::EntryRange BlendPlayer::entry_range(const Action& action,
                                                 const MotionClip& clip) {
  const double asked_s = action.entry_s.value_or(0.0);
  if (clip.loops) return {asked_s, action.entry_search_s};
  const double first_s = std::max(0.0, asked_s - action.entry_search_s);
  const double last_s = std::min(asked_s + action.entry_search_s,
                                 clip.duration_s() - kLeast_s * action.rate);
  const double end_s = std::max(last_s, asked_s);
  return {0.5 * (first_s + end_s), 0.5 * (end_s - first_s)};
}

bool BlendPlayer::may_begin(const Action& action, double time_s, double step_s) const {
  if (action.is_live && !live_->source().has_data()) return false;
  if (action.start == ActionStart::Kind::kNow) return true;
  if (action.start == ActionStart::Kind::kAtTime) return time_s >= action.start_s;
  const Action* other = find(action.after);
  if (other == nullptr || other->phase == ActionPhase::kDone) return true;
  if (!other->is_alive()) return false;
  if (action.start == ActionStart::Kind::kAfter) {
    return other->phase == ActionPhase::kFadingOut;
  }
  const MotionClip& clip = base_->clip(other->clip);
  double before = other->warp.source_s(time_s - step_s);
  double now = other->warp.source_s(time_s);
  if (clip.loops) {
    const double cycles = std::floor(before / clip.duration_s()) * clip.duration_s();
    before -= cycles;
    now -= cycles;
    if (action.start_s < before) return now >= action.start_s + clip.duration_s();
  }
  return before <= action.start_s && action.start_s < now;
}

void BlendPlayer::begin_waiting(double time_s, double step_s) {
  for (std::size_t i = 0; i < count_; ++i) {
    Action& action = actions_[i];
    if (action.phase == ActionPhase::kFadingOut && action.stopped_s < 0.0) {
      action.stopped_s = time_s - step_s;
    }
  }
  // In the order of ids, whatever their layers.
  for (std::size_t n = 0; n < count_; ++n) {
    Action* next = nullptr;
    for (std::size_t i = 0; i < count_; ++i) {
      Action& action = actions_[i];
      if (action.phase != ActionPhase::kQueued) continue;
      if (!may_begin(action, time_s, step_s)) continue;
      if (next == nullptr || action.id < next->id) next = &action;
    }
    if (next == nullptr) return;
    begin(*next, time_s - step_s);
  }
}

void BlendPlayer::retire_replaced(const Action& by, double time_s, bool at_once) {
  for (std::size_t i = 0; i < count_; ++i) {
    Action& other = actions_[i];
    if (&other == &by || !other.is_alive() || other.layer != by.layer) continue;
    bool shares_group = false;
    for (std::size_t g = 0; g < kGroupCount; ++g) {
      shares_group = shares_group || (other.priority[g] > 0.0F && by.priority[g] > 0.0F);
    }
    if (!shares_group) continue;
    if (at_once) {
      other.phase = ActionPhase::kDone;
    } else if (other.phase != ActionPhase::kFadingOut) {
      other.phase = ActionPhase::kFadingOut;
      other.stopped_s = time_s;
      other.fade_out_s = by.fade_in_s;
    }
  }
}

void BlendPlayer::begin_inertial(Action& action, double time_s) {
  action.fade_in_s = 0.0;
  if (action.is_live) return;
  unsigned bearing = 0;
  for (std::size_t part = 0; part < bears_.size(); ++part) {
    if (bears_[part] > 0.5) bearing |= 1U << part;
  }
  const MotionClip& clip = base_->clip(action.clip);
  const EntryRange range = entry_range(action, clip);
  double entry = action.entry_s.value_or(0.0);
  if (is_known_ && action.leg_priority() > 0.0F) {
    entry = best_entry_s(rig_,
                         shown_,
                         rates_,
                         bearing,
                         clip,
                         range.middle_s,
                         range.half_s,
                         clip.loops && !action.entry_s);
  }
  action.warp.start(time_s, entry, action.rate);
}

bool BlendPlayer::synchronise(Action& action, double time_s, bool always) {
  const Action* lead_action = nullptr;
  for (std::size_t i = 0; i < count_; ++i) {
    const Action& other = actions_[i];
    if (&other == &action || !other.is_alive() || other.is_live) continue;
    const float most = std::max(other.leg_priority(), action.leg_priority());
    if (other.leg_priority() <= 0.05F * most) continue;
    if (lead_action == nullptr || other.leg_priority() > lead_action->leg_priority()) {
      lead_action = &other;
    }
  }
  if (lead_action == nullptr) return false;
  const auto side = [&](const Action& a, double now_s, double speed) {
    const MotionClip& clip = base_->clip(a.clip);
    return SyncSide{base_->phases(a.clip), clip.duration_s(), clip.loops, now_s, speed};
  };
  const SyncSide lead_side =
      side(*lead_action, lead_action->warp.source_s(time_s), lead_action->rate);
  SyncOptions sync;
  const EntryRange range = entry_range(action, base_->clip(action.clip));
  sync.entry_s = range.half_s;
  // Replaced actions count until they have faded out.
  if (action.replaces) sync.horizon_s = std::max(action.fade_in_s, 0.2);
  const SyncPlan plan =
      plan_sync(lead_side, side(action, range.middle_s, action.rate), sync);
  report_.incompatible_s = plan.incompatible_s;
  const bool is_good = plan.incompatible_s < options_.max_incompatible_s;
  if (!is_good && !always) return false;
  std::array<WarpKnot, kMaxSyncKnots> knots{};
  for (std::size_t i = 0; i < plan.knot_count; ++i) {
    knots[i] = {time_s + plan.knots[i].time_s, plan.knots[i].source_s};
  }
  const double first_rate =
      plan.knot_count < 2
          ? action.rate
          : (knots[1].source_s - knots[0].source_s) / (knots[1].time_s - knots[0].time_s);
  action.warp.start(
      time_s, knots[0].source_s, std::clamp(first_rate, kMinWarpRate, kMaxWarpRate));
  if (plan.knot_count > 1) {
    (void)action.warp.replan(
        time_s, std::span(knots).subspan(1, plan.knot_count - 1), action.rate, 0.0);
  }
  if (!always && action.replaces) choose_landing(*lead_action, action, range, time_s);
  return true;
}

void BlendPlayer::choose_landing(const Action& lead_action,
                                 Action& action,
                                 const EntryRange& range,
                                 double time_s) {
  EntryQuestion question;
  question.rig = &rig_;
  question.from = &base_->clip(lead_action.clip);
  question.from_source_s = lead_action.warp.source_s(time_s);
  question.from_rate = lead_action.rate;
  question.to = &base_->clip(action.clip);
  question.to_rate = action.rate;
  question.asked_s = action.entry_s.value_or(0.0);
  question.first_s = range.middle_s - range.half_s;
  question.last_s = range.middle_s + range.half_s;
  question.anywhere = question.to->loops && range.half_s > 0.0;
  question.fade_s = action.fade_in_s;
  // The fade has 0.9 after 0.75 of its time.
  question.max_delay_s =
      std::clamp(options_.settle_s - 0.75 * action.fade_in_s, 0.0, kMostDelay_s);
  const double planned_m = entry_landing_cost(
      question, 0.0, action.warp.source_s(time_s + 0.5 * action.fade_in_s));
  const EntryAnswer answer = choose_entry(question);
  if (answer.cost_m >= planned_m) return;
  action.warp.start(time_s, answer.entry_s, action.rate);
  delay_s_ = answer.delay_s;
}

void BlendPlayer::place_warp(Action& action, double time_s) {
  limit_alive(time_s);
  for (PhaseWarp& warp : *warps_) {
    const bool is_taken = std::ranges::any_of(actions(), [&](const Action& other) {
      return other.is_alive() && other.warp.get() == &warp;
    });
    if (is_taken) continue;
    action.warp.place(&warp);
    return;
  }
}

void BlendPlayer::begin(Action& action, double time_s) {
  report_ = {};
  delay_s_ = 0.0;
  place_warp(action, time_s);
  const bool moves_legs = action.leg_priority() > 0.0F;
  const bool meets_others = is_known_ && moves_legs;
  bool at_once = action.transition == TransitionKind::kCut ||
                 action.transition == TransitionKind::kInertial;
  action.warp.start(time_s, action.entry_s.value_or(0.0), action.rate);
  if (at_once) {
    if (action.transition == TransitionKind::kInertial) begin_inertial(action, time_s);
    action.fade_in_s = 0.0;
  } else if (enter_in_step(action, time_s)) {
    report_.is_synchronised = true;
  } else if (meets_others && !action.is_live &&
             action.transition != TransitionKind::kCrossfade) {
    report_.is_synchronised =
        base_->has_contacts(action.clip) &&
        synchronise(action, time_s, action.transition == TransitionKind::kSynchronised);
    if (!report_.is_synchronised && lead() != nullptr &&
        action.transition == TransitionKind::kAuto) {
      begin_inertial(action, time_s);
      at_once = true;
    }
  }
  if (!is_known_) action.fade_in_s = 0.0;
  report_.is_inertial = at_once && action.transition != TransitionKind::kCut;
  action.phase = action.fade_in_s > 0.0 ? ActionPhase::kFadingIn : ActionPhase::kHolding;
  action.started_s = time_s + delay_s_;
  if (action.replaces) retire_replaced(action, action.started_s, at_once);
  if (at_once && is_known_) is_broken_ = true;
  cuts_ = cuts_ || action.transition == TransitionKind::kCut;
  if (moves_legs && is_known_) {
    const double lasts_s = at_once ? 3.0 * options_.half_life_s : action.fade_in_s;
    transition_end_s_ = std::max(transition_end_s_, action.started_s + lasts_s);
  }
}

}  // namespace marey::engine
