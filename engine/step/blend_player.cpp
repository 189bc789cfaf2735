// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/blend_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/actions/action_weights.h"

#include "core/base/assert.h"
#include "core/base/smooth_step.h"

namespace marey::engine {
namespace {

constexpr std::size_t kRootGroup = static_cast<std::size_t>(EditGroup::kRoot);
constexpr std::size_t kLeftLegGroup = static_cast<std::size_t>(EditGroup::kLeftLeg);

// One step of x(t) = (x + (v + x y) t) e^(-y t).
void decay(double& value, double& rate, double half_life_s, double step_s) {
  const double y = 2.0 * 0.6931471805599453 / half_life_s;
  const double j = rate + value * y;
  const double e = std::exp(-y * step_s);
  value = (value + j * step_s) * e;
  rate = (rate - j * y * step_s) * e;
}

// Integral of the decay of decay() over a time.
double decay_sum(double value, double rate, double half_life_s, double time_s) {
  const double y = 2.0 * 0.6931471805599453 / half_life_s;
  const double j = rate + value * y;
  const double e = std::exp(-y * time_s);
  return (value + j / y) / y - e * ((value + j * time_s) / y + j / (y * y));
}

}  // namespace

/// The blend of all alive actions at one time.
struct BlendPlayer::Blend {
  BlendPosture posture;
  RootPlace root_step;  ///< Over the step before its time, in its heading frame. [m]
  PerFootPart bears{};
};

BlendPlayer::BlendPlayer(std::shared_ptr<const MotionBase> base,
                         const Rig& rig,
                         const RootPlace& start,
                         const BlendPlayerOptions& options)
    : base_(std::move(base)), rig_(rig), options_(options), root_(start) {}

void BlendPlayer::add(const Action& action) {
  MAREY_ASSERT(has_room());
  std::size_t at = count_;
  while (at > 0 && actions_[at - 1].layer > action.layer) --at;
  for (std::size_t i = count_; i > at; --i) {
    actions_[i] = std::move(actions_[i - 1]);
    weights_[i] = weights_[i - 1];
  }
  actions_[at] = action;
  weights_[at] = {};
  ++count_;
}

Action* BlendPlayer::find_mutable(ActionId id) {
  return const_cast<Action*>(std::as_const(*this).find(id));
}

const Action* BlendPlayer::find(ActionId id) const {
  for (std::size_t i = 0; i < count_; ++i) {
    if (actions_[i].id == id) return &actions_[i];
  }
  return nullptr;
}

bool BlendPlayer::stop(ActionId id) {
  Action* action = find_mutable(id);
  if (action == nullptr || action->phase == ActionPhase::kDone) return false;
  if (action->phase == ActionPhase::kQueued) {
    action->phase = ActionPhase::kDone;
  } else if (action->phase != ActionPhase::kFadingOut) {
    // The time is set with the next step.
    action->phase = ActionPhase::kFadingOut;
    action->stopped_s = -1.0;
  }
  return true;
}

void BlendPlayer::stop_layer(std::optional<int> layer) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (!layer || actions_[i].layer == *layer) (void)stop(actions_[i].id);
  }
}

const Action* BlendPlayer::lead() const {
  const Action* best = nullptr;
  float most = 0.0F;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!actions_[i].is_alive()) continue;
    const float weight = weights_[i][kLeftLegGroup] + weights_[i][kLeftLegGroup + 1];
    if (weight > most) {
      most = weight;
      best = &actions_[i];
    }
  }
  return best != nullptr && best->is_live ? nullptr : best;
}

std::size_t BlendPlayer::alive(std::span<const Action*> out) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (actions_[i].is_alive()) out[count++] = &actions_[i];
  }
  return count;
}

void BlendPlayer::limit_alive(double time_s) {
  std::array<const Action*, kMaxActions> list{};
  std::size_t count = alive(list);
  while (count > kMaxAlive) {
    const Action* least = nullptr;
    double smallest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      double weight = 0.0;
      for (const float p : list[i]->priority) weight += static_cast<double>(p);
      weight *= static_cast<double>(list[i]->weight) * list[i]->fade(time_s);
      // An action that has just begun is wanted.
      if (list[i]->phase == ActionPhase::kFadingIn) weight += 1e3;
      if (least == nullptr || weight < smallest) {
        least = list[i];
        smallest = weight;
      }
    }
    find_mutable(least->id)->phase = ActionPhase::kDone;
    is_broken_ = is_broken_ || is_known_;
    count = alive(list);
  }
}

void BlendPlayer::end_finished(double time_s) {
  for (std::size_t i = 0; i < count_; ++i) {
    Action& action = actions_[i];
    if (action.phase == ActionPhase::kFadingIn &&
        time_s >= action.started_s + action.fade_in_s) {
      action.phase = ActionPhase::kHolding;
    }
    if (action.phase == ActionPhase::kFadingOut &&
        time_s >= action.stopped_s + action.fade_out_s) {
      action.phase = ActionPhase::kDone;
    }
    if (action.loops || action.phase == ActionPhase::kFadingOut || !action.is_alive()) {
      continue;
    }
    const double left_s =
        (base_->clip(action.clip).duration_s() - action.warp.source_s(time_s)) /
        action.warp.rate(time_s);
    if (left_s <= action.fade_out_s) {
      action.phase = ActionPhase::kFadingOut;
      action.stopped_s = time_s;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (actions_[i].phase == ActionPhase::kDone) continue;
    if (kept != i) {
      actions_[kept] = std::move(actions_[i]);
      weights_[kept] = weights_[i];
    }
    ++kept;
  }
  count_ = kept;
}

bool BlendPlayer::blend_at(double time_s,
                           double from_s,
                           BlendSides& sides,
                           std::array<PerGroup, kMaxActions>& weights_by_action,
                           Blend& out) const {
  std::array<const Action*, kMaxActions> list{};
  const std::size_t count = alive(list);
  if (count == 0) return false;
  std::array<PerGroup, kMaxActions> weights{};
  action_weights({list.data(), count}, time_s, {weights.data(), count});
  std::array<BlendPosture, kMaxAlive> postures;
  std::array<const BlendPosture*, kMaxAlive> sources{};
  out.root_step = {};
  out.bears = {};
  std::array<double, 3> total{};
  for (std::size_t i = 0; i < count; ++i) {
    const RootPlace moves = sample(*list[i], time_s, from_s, postures[i]);
    sources[i] = &postures[i];
    const double share = static_cast<double>(weights[i][kRootGroup]);
    total[2] += share;
    out.root_step.x_m += share * moves.x_m * rig_.leg_length_m;
    out.root_step.z_m += share * moves.z_m * rig_.leg_length_m;
    out.root_step.heading_rad += share * moves.heading_rad;
    const unsigned bits = bearing_bits(*list[i], time_s);
    for (std::size_t part = 0; part < 4; ++part) {
      const double leg = static_cast<double>(weights[i][kLeftLegGroup + part / 2]);
      if (part % 2 == 0) total[part / 2] += leg;
      if ((bits >> part & 1U) != 0U) out.bears[part] += leg;
    }
  }
  for (std::size_t part = 0; part < 4; ++part) {
    if (total[part / 2] > 0.0) out.bears[part] /= total[part / 2];
  }
  if (total[2] > 0.0) {
    out.root_step.x_m /= total[2];
    out.root_step.z_m /= total[2];
    out.root_step.heading_rad /= total[2];
  }
  out.posture = shown_;
  blend_postures({sources.data(), count}, {weights.data(), count}, &sides, out.posture);
  for (std::size_t i = 0; i < count; ++i) {
    weights_by_action[static_cast<std::size_t>(list[i] - actions_.data())] = weights[i];
  }
  return true;
}

bool BlendPlayer::evaluate(double time_s, double step_s, Blend& out) {
  return blend_at(time_s, time_s - step_s, sides_, weights_, out);
}

bool BlendPlayer::predict(double now_s,
                          double time_s,
                          BlendPosture& posture,
                          RootPlace& root) const {
  BlendSides sides = sides_;
  std::array<PerGroup, kMaxActions> weights{};
  Blend blend;
  if (!blend_at(time_s, now_s, sides, weights, blend)) return false;
  posture = blend.posture;
  RootPlace step = blend.root_step;
  const double ahead_s = std::max(0.0, time_s - now_s);
  if (offset_.is_active()) {
    InertialOffset offset = offset_;
    offset.step(
        static_cast<float>(ahead_s), static_cast<float>(options_.half_life_s), posture);
  }
  const auto sum = [&](double value, double rate) {
    return decay_sum(value, rate, options_.half_life_s, ahead_s);
  };
  step.x_m += sum(root_offset_.x_m, root_offset_rate_.x_m);
  step.z_m += sum(root_offset_.z_m, root_offset_rate_.z_m);
  step.heading_rad += sum(root_offset_.heading_rad, root_offset_rate_.heading_rad);
  root = moved(root_, step);
  posture.height_legs += static_cast<float>(lift_m_ / rig_.leg_length_m);
  return true;
}

PerFootPart BlendPlayer::predict_bears(double time_s) const {
  std::array<const Action*, kMaxActions> list{};
  const std::size_t count = alive(list);
  std::array<PerGroup, kMaxActions> weights{};
  action_weights({list.data(), count}, time_s, {weights.data(), count});
  PerFootPart bears{};
  std::array<double, 2> total{};
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned bits = bearing_bits(*list[i], time_s);
    for (std::size_t part = 0; part < 4; ++part) {
      const double leg = static_cast<double>(weights[i][kLeftLegGroup + part / 2]);
      if (part % 2 == 0) total[part / 2] += leg;
      if ((bits >> part & 1U) != 0U) bears[part] += leg;
    }
  }
  for (std::size_t part = 0; part < 4; ++part) {
    if (total[part / 2] > 0.0) bears[part] /= total[part / 2];
  }
  return bears;
}

PhaseWarp* BlendPlayer::warp(ActionId id) {
  Action* action = find_mutable(id);
  return action == nullptr || !action->is_alive() ? nullptr : action->warp.get();
}

void BlendPlayer::move_root(const Blend& blend, double time_s, double step_s) {
  RootPlace step = blend.root_step;
  if (is_broken_ && !cuts_) {
    root_offset_.x_m += root_rate_.x_m - step.x_m / step_s;
    root_offset_.z_m += root_rate_.z_m - step.z_m / step_s;
    root_offset_.heading_rad += root_rate_.heading_rad - step.heading_rad / step_s;
  }
  decay(root_offset_.x_m, root_offset_rate_.x_m, options_.half_life_s, step_s);
  decay(root_offset_.z_m, root_offset_rate_.z_m, options_.half_life_s, step_s);
  decay(root_offset_.heading_rad,
        root_offset_rate_.heading_rad,
        options_.half_life_s,
        step_s);
  step.x_m += root_offset_.x_m * step_s;
  step.z_m += root_offset_.z_m * step_s;
  step.heading_rad += root_offset_.heading_rad * step_s;
  const FootPlaces now = foot_places(rig_, shown_);
  anchor_.observe(blend.bears, step_s);
  const double change = step_s / options_.anchor_fade_s;
  anchor_strength_ = std::clamp(
      anchor_strength_ + (time_s <= transition_end_s_ ? change : -change), 0.0, 1.0);
  if (options_.anchors_root && anchor_strength_ > 0.0 && is_known_) {
    step = anchor_.displacement(
        step, feet_, now, rig_.leg_length_m, smooth_step(anchor_strength_));
  }
  root_ = moved(root_, step);
  root_rate_ = {step.x_m / step_s, step.z_m / step_s, step.heading_rad / step_s};
  feet_ = now;
}

double BlendPlayer::anchored() const {
  return options_.anchors_root ? smooth_step(anchor_strength_) : 0.0;
}

void BlendPlayer::turn_about(double x_m, double z_m, double turn_rad) {
  const double c = std::cos(turn_rad);
  const double s = std::sin(turn_rad);
  const double dx = root_.x_m - x_m;
  const double dz = root_.z_m - z_m;
  root_ = {x_m + c * dx + s * dz, z_m - s * dx + c * dz, root_.heading_rad + turn_rad};
}

bool BlendPlayer::step(double time_s, double step_s) {
  is_broken_ = false;
  cuts_ = false;
  step_live(time_s, step_s);
  begin_waiting(time_s, step_s);
  limit_alive(time_s);
  Blend blend;
  if (!evaluate(time_s, step_s, blend)) {
    // Nothing plays: the last posture stays.
    end_finished(time_s);
    return is_known_;
  }
  if (is_broken_ && !cuts_) {
    Blend before;
    (void)evaluate(time_s - step_s, step_s, before);
    offset_.start(
        shown_,
        rates_,
        before.posture,
        rates_between(before.posture, blend.posture, static_cast<float>(step_s)));
    (void)evaluate(time_s, step_s, blend);
  }
  offset_.step(static_cast<float>(step_s),
               static_cast<float>(options_.half_life_s),
               blend.posture);
  if (is_known_) {
    rates_ = rates_between(shown_, blend.posture, static_cast<float>(step_s));
  }
  shown_ = blend.posture;
  if (!is_known_) {
    // The start is the place at the entry of the first action, a step ago.
    root_ = moved(root_, blend.root_step);
    feet_ = foot_places(rig_, shown_);
    root_rate_ = {blend.root_step.x_m / step_s,
                  blend.root_step.z_m / step_s,
                  blend.root_step.heading_rad / step_s};
    anchor_.observe(blend.bears, step_s);
    is_known_ = true;
  } else {
    move_root(blend, time_s, step_s);
  }
  bears_ = blend.bears;
  end_finished(time_s);
  return true;
}

}  // namespace marey::engine
