// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <utility>

#include "engine/sources/stride_phase.h"
#include "engine/step/blend_player.h"

// The sources of actions: clips, and the postures of a performer.

namespace marey::engine {
namespace {

// Displacement of a clip's root between two of its times; both are moved to the first
// cycles, so that the path of a loop is never summed over many.
RootPlace root_step(const MotionClip& clip, double from_s, double to_s) {
  if (clip.loops) {
    const double duration = clip.duration_s();
    const double base = std::floor(from_s / duration) * duration;
    from_s -= base;
    to_s -= base;
  }
  return relative(path_at(clip, from_s), path_at(clip, to_s));
}

}  // namespace

void BlendPlayer::add_live(const Action& action, const LiveOptions& options) {
  if (live_ != nullptr) (void)stop(live_->action());
  live_ = std::make_unique<LivePlayer>(action.id, options);
  add(action);
}

const LivePlayer* BlendPlayer::live() const {
  if (live_ == nullptr) return nullptr;
  const Action* action = find(live_->action());
  const bool is_over = action == nullptr || action->phase == ActionPhase::kDone;
  return is_over ? nullptr : live_.get();
}

LivePlayer* BlendPlayer::live() {
  return const_cast<LivePlayer*>(std::as_const(*this).live());
}

void BlendPlayer::step_live(double time_s, double step_s) {
  LivePlayer* playing = live();
  if (playing == nullptr) return;
  playing->step(time_s, step_s, *base_, {actions_.data(), count_});
  // While the legs change between the source and clips, bearing feet lead the root.
  const float share =
      playing->source().report().share[static_cast<std::size_t>(EditGroup::kLeftLeg)];
  if (share > 0.01F && share < 0.99F) transition_end_s_ = time_s;
}

bool BlendPlayer::enter_in_step(Action& action, double time_s) const {
  if (action.is_live || !action.loops || action.entry_s) return false;
  if (action.leg_priority() <= 0.0F || live() == nullptr) return false;
  const auto phase = live_->lead_phase(time_s);
  if (!phase) return false;
  const auto entry_s = time_of_stride(base_->clip(action.clip), *phase);
  if (!entry_s) return false;
  action.warp.start(time_s, *entry_s, action.rate);
  return true;
}

RootPlace BlendPlayer::sample(const Action& action,
                              double time_s,
                              double from_s,
                              BlendPosture& out) const {
  if (action.is_live) {
    live_->source().sample(time_s, out);
    return live_->source().root_step(from_s, time_s);
  }
  const MotionClip& clip = base_->clip(action.clip);
  const double source_s = action.warp.source_s(time_s);
  sample_clip(clip, source_s, out);
  return root_step(clip, action.warp.source_s(from_s), source_s);
}

unsigned BlendPlayer::bearing_bits(const Action& action, double time_s) const {
  if (action.is_live) return live_->source().bears();
  return bearing_at(base_->clip(action.clip), action.warp.source_s(time_s));
}

}  // namespace marey::engine
