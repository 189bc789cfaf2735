// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/live_player.h"

#include <algorithm>
#include <cmath>

namespace marey::engine {
namespace {

// Time constants of a follower's rate: while it keeps step, and on its way back to the
// rate that was asked for. [s]
constexpr double kLockedLag_s = 0.1;
constexpr double kFreeLag_s = 0.3;
// Actions with a smaller share of the greatest priority on the legs do not follow.
constexpr float kLeastLegShare = 0.05F;

}  // namespace

std::optional<double> LivePlayer::lead_phase(double time_s) const {
  return leads_ ? phase_.phase(time_s) : std::nullopt;
}

LivePlayer::Follower* LivePlayer::follower(const Action& action,
                                           std::span<const Action> actions) {
  for (Follower& known : followers_) {
    if (known.id == action.id) return &known;
  }
  for (Follower& place : followers_) {
    const bool is_used = std::ranges::any_of(
        actions, [&](const Action& a) { return a.id == place.id && a.is_alive(); });
    if (is_used) continue;
    place = Follower();
    place.id = action.id;
    return &place;
  }
  return nullptr;
}

void LivePlayer::follow(Follower& by,
                        double time_s,
                        double step_s,
                        const MotionClip& clip,
                        Action& action) const {
  const double from_s = time_s - step_s;
  const double source_s = action.warp.source_s(from_s);
  const auto lead = lead_phase(from_s);
  const auto own = lead ? stride_phase(clip, source_s) : std::nullopt;
  if (!own && !by.is_locked) return;
  if (!by.is_locked) by.rate = action.warp.rate(from_s);
  // A performer who is lost is thought to go on at his tempo.
  double wanted = source_.report().is_lost ? by.rate : action.rate;
  if (own) {
    if (!by.is_led) by.lock.start(clip.duration_s() / count_strides(clip), by.rate);
    by.is_locked = true;
    wanted = by.lock.step(from_s, *lead, *own);
  }
  by.is_led = own.has_value();
  const double lag_s = own ? kLockedLag_s : kFreeLag_s;
  by.rate += (wanted - by.rate) * -std::expm1(-step_s / lag_s);
  by.rate = std::clamp(by.rate, kMinWarpRate, kMaxWarpRate);
  if (!own && std::abs(by.rate - action.rate) < 1e-4 * action.rate) {
    by.rate = action.rate;
    by.is_locked = false;
  }
  action.warp.start(from_s, source_s, by.rate);
}

void LivePlayer::step(double time_s,
                      double step_s,
                      const MotionBase& base,
                      std::span<Action> actions) {
  if (!source_.has_data()) return;
  source_.step(time_s, step_s);
  if (source_.report().is_lost) {
    phase_.interrupt();
  } else if (!has_observed_ || source_.newest_s() > observed_s_) {
    phase_.observe(source_.newest_s(), source_.bears());
    observed_s_ = source_.newest_s();
    has_observed_ = true;
  }
  leads_ = false;
  float most = 0.0F;
  for (Action& action : actions) {
    if (action.id == action_) {
      action.source_share = source_.report().share;
      leads_ = action.is_alive() && action.leg_priority() > 0.0F;
    }
    if (action.is_alive()) most = std::max(most, action.leg_priority());
  }
  for (Action& action : actions) {
    if (action.is_live || !action.is_alive() || !action.loops) continue;
    if (action.leg_priority() <= kLeastLegShare * most) continue;
    if (Follower* by = follower(action, actions)) {
      follow(*by, time_s, step_s, base.clip(action.clip), action);
    }
  }
}

}  // namespace marey::engine
