// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/steer_player.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace marey::engine {
namespace {

// Clip time until a foot next changes between bearing and not bearing.
double until_edge_s(const MotionClip& clip, std::size_t side, double source_s) {
  const double duration = clip.duration_s();
  const double now = source_s - std::floor(source_s / duration) * duration;
  const bool bears = (bearing_at(clip, now) >> (2 * side) & 3U) != 0U;
  double soonest = std::numeric_limits<double>::infinity();
  for (std::size_t part = 2 * side; part < 2 * side + 2; ++part) {
    for (const ClipSpan& span : clip.contacts[part]) {
      for (const double edge :
           {static_cast<double>(span.start_s), static_cast<double>(span.end_s)}) {
        double until = edge - now;
        if (until <= 1e-9) until += duration;
        // The edge counts if the foot is in the other state after it.
        const double after = now + until + 1e-6;
        const bool then = (bearing_at(clip, after) >> (2 * side) & 3U) != 0U;
        if (then != bears) soonest = std::min(soonest, until);
      }
    }
  }
  return std::isfinite(soonest) ? soonest : duration;
}

}  // namespace

Result<SteerPlayer> SteerPlayer::make(const MotionBase& base,
                                      ActionId action,
                                      std::size_t clip,
                                      const SteerWish& wish) {
  auto travel = travel_of_clip(base.clip(clip));
  if (!travel) return travel.error();
  SteerPlayer out;
  out.action_ = action;
  out.clip_ = clip;
  out.travel_ = std::make_unique<ClipTravel>(*std::move(travel));
  const Status started = out.course_.start(base.clip(clip), *out.travel_, wish.settings);
  if (!started) return started.error();
  const Status aimed = out.course_.aim(wish.goal_xz_m);
  if (!aimed) return aimed.error();
  return out;
}

void SteerPlayer::step(double time_s,
                       double step_s,
                       const std::array<glm::dvec2, 2>& ankle_xz_m,
                       const std::array<bool, 2>& bears,
                       BlendPlayer& blend) {
  const Action* action = blend.find(action_);
  if (action == nullptr || !action->is_alive() || last_.arrived) return;
  const MotionClip& clip = blend.base().clip(clip_);
  SteerInput input;
  input.time_s = time_s;
  input.step_s = step_s;
  input.root = blend.root();
  input.clip_s = action->warp.source_s(time_s);
  input.rate = action->warp.rate(time_s);
  input.foot_xz_m = ankle_xz_m;
  input.bears = bears;
  for (std::size_t side = 0; side < 2; ++side) {
    input.until_edge_s[side] = until_edge_s(clip, side, input.clip_s) / input.rate;
  }
  input.leg_length_m = blend.rig().leg_length_m;
  last_ = course_.step(input);
  blend.place(steered(blend.root(), last_));
  if (last_.state != SteerState::kUnderWay) (void)blend.stop(action_);
}

}  // namespace marey::engine
