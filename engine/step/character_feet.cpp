// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "engine/feet/lead_legs.h"
#include "engine/step/character_player.h"
#include "engine/step/landing.h"

#include "core/base/smooth_step.h"

// The feet of a character: they meet the floor, stand, and lead legs and root.

namespace marey::engine {
namespace {

// A foot that lifts for less than this does not lift.
constexpr double kShortest_s = 0.1;
// Fade of the hips' drop for a foot that begins or ceases to stand.
constexpr double kStandFade_s = 0.12;
// Hips joints are up to 0.12 legs above the hip centres, or at their height: a clip of
// one such body is that much too high on the other.
constexpr double kMaxLift_legs = 0.2;

}  // namespace

void CharacterPlayer::forget_feet() {
  for (FootHold& foot : feet_) foot.reset();
  floor_.reset();
  pull_.reset();
  blend_.set_lift(0.0);
  stand_share_ = {};
  report_.stands = {};
}

void CharacterPlayer::observe_bearing(double time_s) {
  for (std::size_t side = 0; side < 2; ++side) {
    const std::array<bool, 2> bore = bore_[side];
    for (std::size_t part = 0; part < 2; ++part) {
      bore_[side][part] =
          blend_.bears()[2 * side + part] > (bore[part] ? kBearsUntil : kBearsAbove);
    }
    if (bore_[side][0] || bore_[side][1] || (!bore[0] && !bore[1])) continue;
    if (next_landing(blend_, side, time_s, kShortest_s)) bore_[side] = bore;
  }
}

void CharacterPlayer::meet_floor(double step_s) {
  const auto feet = feet_of_posture(blend_.rig(), root_, posture_);
  std::optional<double> sole_m;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!bore_[side][0] && !bore_[side][1]) continue;
    const retarget::FootMap& foot = map_->feet[side];
    double height_m = feet[side].ankle_in_world.y - foot.ankle_height_m;
    if (!bore_[side][0]) {
      height_m += (feet[side].world_from_t_pose * foot.ball_from_ankle_in_t_pose).y +
                  foot.ankle_height_m - foot.ball_height_m;
    }
    sole_m = std::min(sole_m.value_or(height_m), height_m);
  }
  // The lift rests while a ball leaves a hand: its speed would be the ball's, too.
  for (const auto& made : throws_) {
    if (made && made->is_releasing(time_s_, step_s)) sole_m.reset();
  }
  const double lift_m = smooth_step(activation_) *
                        floor_.step(sole_m, kMaxLift_legs * map_->leg_length_m, step_s);
  blend_.set_lift(lift_m);
  posture_.height_legs += static_cast<float>(lift_m / map_->leg_length_m);
}

FootReference CharacterPlayer::foot_reference(std::size_t side,
                                              const LedFoot& foot,
                                              double time_s) const {
  FootReference out;
  out.ankle_in_world = foot.ankle_in_world;
  out.world_from_t_pose = foot.world_from_t_pose;
  out.heel_bears = bore_[side][0];
  out.ball_bears = bore_[side][1];
  out.steered_rad = steered_rad_;
  if (!out.heel_bears && !out.ball_bears) {
    out.landing = next_landing(blend_, side, time_s, foot_options_.land_s);
  }
  return out;
}

void CharacterPlayer::hold_feet(double time_s, double step_s) {
  observe_bearing(time_s);
  meet_floor(step_s);
  const double share = smooth_step(activation_);
  const double change = step_s / kStandFade_s;
  glm::dvec2 away_m(0.0);
  double standing = 0.0;
  led_ = feet_of_posture(blend_.rig(), root_, posture_);
  for (std::size_t side = 0; side < 2; ++side) {
    const FootReference reference = foot_reference(side, led_[side], time_s);
    const FootHold::Place place = feet_[side].step(
        reference, map_->feet[side], blend_.rig().leg_length_m, step_s, foot_options_);
    report_.stands[side] = feet_[side].holds();
    ankle_xz_m_[side] = {place.ankle_in_world.x, place.ankle_in_world.z};
    stand_share_[side] = std::clamp(
        stand_share_[side] + (report_.stands[side] ? change : -change), 0.0, 1.0);
    led_[side].ankle_in_world =
        glm::mix(reference.ankle_in_world, place.ankle_in_world, share);
    led_[side].world_from_t_pose = glm::normalize(
        glm::slerp(reference.world_from_t_pose, place.world_from_t_pose, share));
    led_[side].stands = smooth_step(stand_share_[side]);
    StandingFoot& now = shift_.feet[side];
    now.stands = report_.stands[side];
    now.ankle_in_world = led_[side].ankle_in_world;
    now.world_from_t_pose = led_[side].world_from_t_pose;
    now.from_reference_m = now.ankle_in_world - reference.ankle_in_world;
    if (!report_.stands[side]) continue;
    away_m += ankle_xz_m_[side] -
              glm::dvec2(reference.ankle_in_world.x, reference.ankle_in_world.z);
    standing += 1.0;
  }
  blend_hips_in_world_ = {root_.x_m,
                          map_->leg_length_m * static_cast<double>(posture_.height_legs),
                          root_.z_m};
  lead_legs(blend_.rig(), root_, share, led_, posture_);
  // Acts on the next step.
  const double pulled = share * blend_.anchored() / std::max(1.0, standing);
  const glm::dvec2 pull_m = pull_.step(pulled * away_m, step_s);
  RootPlace root = blend_.root();
  root.x_m += pull_m.x;
  root.z_m += pull_m.y;
  blend_.place(root);
}

void CharacterPlayer::lead_feet() {
  for (std::size_t side = 0; side < 2; ++side) {
    supports_[side]->set_target(led_[side].ankle_in_world);
    supports_[side]->set_orientation(led_[side].world_from_t_pose);
  }
}

}  // namespace marey::engine
