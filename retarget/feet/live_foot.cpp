// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/live_foot.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/transform.h"
#include "core/base/smooth_step.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

glm::dquat heading_of(const glm::dquat& foot) {
  const glm::dvec3 ahead = foot * glm::dvec3(0, 0, 1);
  return glm::angleAxis(std::atan2(ahead.x, ahead.z), glm::dvec3(0, 1, 0));
}

}  // namespace

LiveFoot::Mode LiveFoot::mode_of(const StandingFoot& stands) {
  if (stands.heel && stands.ball) return Mode::kFlat;
  if (stands.heel) return Mode::kHeel;
  return stands.ball ? Mode::kBall : Mode::kFree;
}

// Sets the place of the bearing joint from now on: its current one, on the floor.
void LiveFoot::begin(Mode mode, const FootMap& foot, const FootPlace& reference) {
  const FootPlace& from = is_known_ ? last_ : reference;
  const bool was_bearing = is_known_ && mode_ != Mode::kFree;
  if (mode == Mode::kFlat && mode_ != Mode::kFlat) heading_ = heading_of(reference.foot);
  if (mode == Mode::kFree) return;
  const glm::dvec3 flat = foot.ball_from_ankle_in_t_pose;
  if (mode == Mode::kBall) {
    // From flat to the ball alone nothing moves: the ball stays where the flat foot had
    // it.
    anchor_in_world_ = from.ankle_in_world + from.foot * flat;
    anchor_in_world_.y = foot.ball_height_m;
    return;
  }
  if (mode == Mode::kFlat && was_bearing && mode_ == Mode::kBall) {
    // The ball stays; the heel comes down behind it.
    anchor_in_world_ -= heading_ * flat;
  } else {
    anchor_in_world_ = from.ankle_in_world;
  }
  anchor_in_world_.y = foot.ankle_height_m;
}

void LiveFoot::turn_along(const FootMap& foot, const FootPlace& reference) {
  // 4 degrees; FootprintOptions::flat_rad is the limit of whole motions. A foot steeper
  // than 70 degrees has no yaw.
  constexpr double kPlay_rad = 0.07;
  constexpr double kMinCosine = 0.34;
  const glm::dvec3 ahead = reference.foot * glm::dvec3(0, 0, 1);
  if (glm::length(glm::dvec2(ahead.x, ahead.z)) < kMinCosine) return;
  const glm::dvec3 now = glm::conjugate(heading_) * ahead;
  const double apart_rad = std::atan2(now.x, now.z);
  const double turn_rad = apart_rad - std::clamp(apart_rad, -kPlay_rad, kPlay_rad);
  if (turn_rad == 0.0) return;
  const glm::dvec3 flat = foot.ball_from_ankle_in_t_pose;
  const glm::dquat before = heading_;
  heading_ = glm::normalize(glm::angleAxis(turn_rad, glm::dvec3(0, 1, 0)) * heading_);
  anchor_in_world_ += before * flat - heading_ * flat;
}

// Returns the foot's target in the current mode, without remaining offsets.
FootPlace LiveFoot::aim(const FootMap& foot, const FootPlace& reference) const {
  FootPlace aim = reference;
  switch (mode_) {
    case Mode::kFree:
      break;
    case Mode::kFlat:
      aim = {anchor_in_world_, heading_, heading_};
      break;
    case Mode::kHeel:
      keep_other_joint_up(foot, true, aim);
      aim.ankle_in_world = anchor_in_world_;
      break;
    case Mode::kBall:
      keep_other_joint_up(foot, false, aim);
      aim.toes = heading_of(reference.toes);
      aim.ankle_in_world = anchor_in_world_ - aim.foot * foot.ball_from_ankle_in_t_pose;
      break;
  }
  return aim;
}

void LiveFoot::hold(const StandingFoot& stands,
                    const FootMap& foot,
                    double leg_length_m,
                    double since_last_s,
                    const LiveFootOptions& options,
                    FootPlace& place) {
  const FootPlace reference = place;
  const glm::dvec3 ball = foot.ball_from_ankle_in_t_pose;
  Mode mode = mode_of(stands);
  if (is_known_ && mode != Mode::kFree) {
    const glm::dvec3 behind = last_.ankle_in_world - last_reference_.ankle_in_world;
    const double slip_m = options.slip_legs * leg_length_m;
    if (glm::length(glm::dvec2(behind.x, behind.z)) > slip_m) mode = Mode::kFree;
  }
  since_change_s_ += since_last_s;
  if (!is_known_ || mode != mode_) {
    begin(mode, foot, reference);
    mode_ = mode;
    since_change_s_ = is_known_ ? since_last_s : 1e9;
    // The offset of the last result from the last posture's target in the new mode.
    const FootPlace aimed = aim(foot, is_known_ ? last_reference_ : reference);
    const FootPlace& was = is_known_ ? last_ : aimed;
    left_over_m_ = was.ankle_in_world - aimed.ankle_in_world;
    if (mode == Mode::kBall) left_over_m_ += was.foot * ball - aimed.foot * ball;
    foot_left_over_rad_ = rotation_vector(was.foot * glm::conjugate(aimed.foot));
    toes_left_over_rad_ = rotation_vector(was.toes * glm::conjugate(aimed.toes));
  }
  if (mode_ == Mode::kFlat) turn_along(foot, reference);
  const double fade_s = mode_ == Mode::kFree ? options.release_s : options.land_s;
  const double left = 1.0 - smooth_step(since_change_s_ / fade_s);
  const FootPlace aimed = aim(foot, reference);
  place.foot =
      glm::normalize(rotation_from_vector(left * foot_left_over_rad_) * aimed.foot);
  place.toes =
      glm::normalize(rotation_from_vector(left * toes_left_over_rad_) * aimed.toes);
  if (mode_ == Mode::kBall) {
    // The ball keeps its place while the foot still turns.
    place.ankle_in_world = anchor_in_world_ + left * left_over_m_ - place.foot * ball;
  } else {
    place.ankle_in_world = aimed.ankle_in_world + left * left_over_m_;
  }
  // A foot that rolls over its heel rises on it.
  if (mode_ == Mode::kHeel || mode_ == Mode::kBall) lift_over_floor(foot, 0.0, place);
  if (mode_ == Mode::kFree) {
    constexpr double kSoftnessInLegs = 0.01;
    lift_over_floor(
        foot,
        kSoftnessInLegs * leg_length_m * smooth_step(since_change_s_ / options.release_s),
        place);
  }
  if (mode_ == Mode::kFree || mode_ == Mode::kHeel) keep_toes_up(foot, place);
  is_known_ = true;
  last_ = place;
  last_reference_ = reference;
}

}  // namespace marey::retarget
