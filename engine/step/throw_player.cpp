// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/throw_player.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/smooth_step.h"

namespace marey::engine {
namespace {

// Distance of the instants from which velocities are derived: the error of the second
// order is below 1e-4 of the speed of a throw, that of rounding below 1e-3 m/s.
constexpr double kInstant_s = 1e-3;
constexpr double kSameInstant_s = 1e-6;
constexpr double kCarryFilter_s = 0.03;
constexpr int kMaxReplans = 6;
// A transition of the legs is not disturbed by the instant unless the release is near.
constexpr double kNear_s = 0.5;

glm::dvec3 from_heading(const RootPlace& root, const glm::dvec3& p) {
  const double c = std::cos(root.heading_rad);
  const double s = std::sin(root.heading_rad);
  return {root.x_m + c * p.x + s * p.z, p.y, root.z_m - s * p.x + c * p.z};
}

HandMotion still_hand(const RigidTransform& wrist) {
  HandMotion out;
  out.p_in_world = wrist.translation;
  out.world_from_hand = wrist.rotation;
  return out;
}

}  // namespace

bool ThrowPlayer::forecast(const ThrowStage& stage, ThrowInstant& out) {
  std::array<RigidTransform, 3> wrist;
  for (std::size_t k = 0; k < 3; ++k) {
    const double at_s = release_s_ - kInstant_s * static_cast<double>(2 - k);
    if (!rehearsal_.predict(stage.time_s, at_s, stage.blend)) return false;
    wrist[k] = posed_wrist(rehearsal_.joints(), *map_, wish_.side);
  }
  out.wrist = hand_motion_until(wrist[0], wrist[1], wrist[2], kInstant_s);
  out.root = posed_root(rehearsal_.joints(), *map_);
  out.root.x_m += hips_from_blend_.x_m;
  out.root.z_m += hips_from_blend_.z_m;
  out.root.heading_rad += hips_from_blend_.heading_rad;
  out.lever_in_hand_m = lever_m_;
  return true;
}

void ThrowPlayer::begin(const Action& action) {
  phase_ = Phase::kRunning;
  const double entry_s = action.warp.source_s(action.started_s);
  start_s_ = action.started_s - entry_s / action.rate;
  if (entry_s >= event_s_) phase_ = Phase::kOver;
}

// Plays the clip so that its event happens at the wanted instant.
void ThrowPlayer::keep_instant(const ThrowStage& stage,
                               const Action& action,
                               PhaseWarp& warp) {
  release_s_ = event_time_s(warp, stage.time_s, event_s_);
  const double wanted_s = start_s_ + wanted().release_s / action.rate;
  const bool is_free = action.phase != ActionPhase::kFadingIn ||
                       wanted_s - stage.time_s < kNear_s ||
                       release_s_ - stage.time_s < kNear_s;
  if (!is_free || replans_ >= kMaxReplans ||
      std::abs(release_s_ - wanted_s) < kSameInstant_s ||
      std::min(wanted_s, release_s_) - stage.time_s < 4.0 * stage.step_s) {
    return;
  }
  ++replans_;
  const WarpKnot knot{wanted_s, event_s_};
  (void)warp.replan(stage.time_s, {&knot, 1}, action.rate, stage.step_s);
  release_s_ = event_time_s(warp, stage.time_s, event_s_);
}

void ThrowPlayer::follow_aim(const ThrowInstant& at_release) {
  if (!wish_.aim_in_world) return;
  ThrowParameters wanted = course_.wanted();
  const glm::dvec3 ball = from_heading(at_release.root, wanted.wrist_in_heading_m) +
                          at_release.wrist.world_from_hand * lever_m_;
  const auto aim =
      aim_ball(ball, *wish_.aim_in_world, wanted.speed_m_s, wish_.ball, wish_.arc);
  aim_in_range_ = aim.has_value();
  if (!aim) return;
  wanted.azimuth_rad =
      std::remainder(aim->azimuth_rad - at_release.root.heading_rad, 6.283185307179586);
  wanted.elevation_rad = aim->elevation_rad;
  aim_time_s_ = aim->time_s;
  course_.want(wanted);
}

void ThrowPlayer::set_hand(const ThrowStage& stage,
                           const glm::dvec3& wrist_in_world,
                           const glm::dquat& world_from_hand) const {
  retarget::Adapter::Handle point = stage.point;
  retarget::Adapter::Handle turn = stage.turn;
  point.set_target(wrist_in_world + world_from_hand * palm_in_t_pose_);
  turn.set_orientation(glm::normalize(world_from_hand));
}

// Poses the body at the release as it is planned, for the place of its hips then.
void ThrowPlayer::rehearse(const ThrowStage& stage, const ThrowInstant& at_release) {
  const RootPlace blend = posed_root(rehearsal_.joints(), *map_);
  set_hand(stage,
           from_heading(at_release.root, wanted().wrist_in_heading_m),
           at_release.wrist.world_from_hand);
  const auto joints =
      rehearsal_.adapt(release_s_, stage.shift, stage.supports, stage.adapter);
  const RootPlace posed = posed_root(joints, *map_);
  hips_from_blend_ = {posed.x_m - blend.x_m,
                      posed.z_m - blend.z_m,
                      posed.heading_rad - blend.heading_rad};
}

// The hips as adapted carry the wrist at the begin and the end, so that the constraints
// start and stop where the hand is. Hips that the hand's own constraints move must not
// move the hand: the loop would amplify it.
glm::dvec3 ThrowPlayer::carried(double time_s) const {
  if (time_s < release_s_) {
    const double into = smooth_step((time_s - begin_s_) / (release_s_ - begin_s_));
    return (1.0 - into) * carries_from_m_;
  }
  return smooth_step((time_s - release_s_) / wish_.half_width_s) * carries_to_m_;
}

void ThrowPlayer::measure(const ThrowStage& stage) {
  std::array<RigidTransform, 3> wrist;
  RootPlace root;
  for (std::size_t k = 0; k < 3; ++k) {
    const double at_s = release_s_ - kInstant_s * static_cast<double>(2 - k);
    if (!rehearsal_.predict(stage.time_s, at_s, stage.blend)) return;
    const RigidTransform hand = posed_wrist(rehearsal_.joints(), *map_, wish_.side);
    set_hand(stage,
             hand.translation + course_.planned(at_s).value + carried(at_s),
             hand.rotation);
    const auto joints =
        rehearsal_.adapt(at_s, stage.shift, stage.supports, stage.adapter);
    wrist[k] = posed_wrist(joints, *map_, wish_.side);
    root = posed_root(joints, *map_);
  }
  ThrowInstant posed;
  posed.wrist = hand_motion_until(wrist[0], wrist[1], wrist[2], kInstant_s);
  posed.root = root;
  posed.lever_in_hand_m = lever_m_;
  ThrowResult result;
  result.wanted = course_.wanted();
  result.measured = measure_throw(posed, (release_s_ - start_s_) * rate_);
  result.ball = {release_s_, ball_place(posed), ball_velocity_m_s(posed)};
  if (wish_.aim_in_world && aim_in_range_) {
    const BallState there = ball_at(
        result.ball.p_in_world, result.ball.velocity_m_s, aim_time_s_, wish_.ball);
    result.aim_miss_m = glm::distance(there.p_in_world, *wish_.aim_in_world);
  }
  result_ = result;
}

void ThrowPlayer::hold_hand(const ThrowStage& stage) {
  if (holds_) return;
  retarget::Adapter::Handle point = stage.point;
  retarget::Adapter::Handle turn = stage.turn;
  point.start(stage.time_s - stage.step_s);
  turn.start(stage.time_s - stage.step_s);
  begin_s_ = stage.time_s - stage.step_s;
  hips_from_blend_ = {stage.shift.hips_m.x, stage.shift.hips_m.z, 0.0};
  carries_from_m_ = stage.shift.hips_m;
  holds_ = true;
}

void ThrowPlayer::drop(double time_s,
                       retarget::Adapter::Handle point,
                       retarget::Adapter::Handle turn) {
  if (holds_) {
    point.stop(time_s);
    turn.stop(time_s);
  }
  holds_ = false;
  phase_ = Phase::kOver;
}

void ThrowPlayer::step(const ThrowStage& stage) {
  if (phase_ == Phase::kOver) return;
  const Action* action = stage.blend.find(action_);
  if (phase_ == Phase::kWaiting) {
    if (action != nullptr && action->phase == ActionPhase::kQueued) return;
    if (action == nullptr) {
      phase_ = Phase::kOver;
      return;
    }
    begin(*action);
    if (phase_ == Phase::kOver) return;
  }
  const RigidTransform now = posed_wrist(stage.reference, *map_, wish_.side);
  ThrowInput input;
  input.time_s = stage.time_s;
  input.step_s = stage.step_s;
  input.clip_now = still_hand(now);
  if (!result_) {
    PhaseWarp* warp = stage.blend.warp(action_);
    if (warp == nullptr) {
      drop(stage.time_s, stage.point, stage.turn);
      return;
    }
    const bool is_past = release_s_ > 0.0 && release_s_ <= stage.time_s && holds_;
    if (!is_past) keep_instant(stage, *action, *warp);
    if (release_s_ - wish_.half_width_s > stage.time_s) return;
    hold_hand(stage);
    if (!forecast(stage, input.clip_at_release)) {
      drop(stage.time_s, stage.point, stage.turn);
      return;
    }
    if (is_past) {
      measure(stage);
    } else if (release_s_ - stage.time_s > stage.step_s) {
      follow_aim(input.clip_at_release);
      rehearse(stage, input.clip_at_release);
      (void)forecast(stage, input.clip_at_release);
    }
  }
  if (result_) {
    carries_to_m_ += std::min(1.0, stage.step_s / kCarryFilter_s) *
                     (stage.shift.hips_m - carries_to_m_);
  }
  input.release_s = release_s_;
  const ThrowOutput output = course_.step(input);
  set_hand(stage, output.wrist.p_in_world + carried(stage.time_s), now.rotation);
  if (stage.time_s >= release_s_ + wish_.half_width_s) {
    drop(stage.time_s, stage.point, stage.turn);
  }
}

}  // namespace marey::engine
