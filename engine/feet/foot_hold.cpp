// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/foot_hold.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

// Distance in which a foot of velocity v stops by a quintic of duration T, over v T: it
// does not turn back from 1/3 on.
constexpr double kStopShare = 0.4;

glm::dvec3 rotation_vector(const glm::dquat& q) {
  const glm::dquat p = q.w < 0.0 ? -q : q;
  const glm::dvec3 v(p.x, p.y, p.z);
  const double sine = glm::length(v);
  if (sine < 1e-12) return 2.0 * v;
  return v * (2.0 * std::atan2(sine, p.w) / sine);
}

glm::dquat rotation_by(const glm::dvec3& vector_rad) {
  const double angle = glm::length(vector_rad);
  if (angle < 1e-12) {
    return glm::normalize(
        glm::dquat(1.0, 0.5 * vector_rad.x, 0.5 * vector_rad.y, 0.5 * vector_rad.z));
  }
  return glm::angleAxis(angle, vector_rad / angle);
}

glm::dvec3 turn_between(const glm::dquat& from, const glm::dquat& to) {
  return rotation_vector(to * glm::conjugate(from));
}

// One step of a fade from `state` to `end`, of which `left_s` remain.
void fade(Motion2<glm::dvec3>& state,
          const Motion2<glm::dvec3>& end,
          double left_s,
          double step_s) {
  state = left_s > step_s * 1.001 ? quintic(state, end, left_s, step_s) : end;
}

glm::dquat about_vertical(double yaw_rad) {
  return {std::cos(0.5 * yaw_rad), 0.0, std::sin(0.5 * yaw_rad), 0.0};
}

double yaw_of(const glm::dquat& rotation) {
  return 2.0 * std::atan2(rotation.y, rotation.w);
}

}  // namespace

FootHold::Mode FootHold::mode_of(const FootReference& reference,
                                 const retarget::FootMap& foot,
                                 double leg_length_m,
                                 const FootHoldOptions& options) {
  const bool bears = reference.heel_bears || reference.ball_bears;
  if (!bears) slipped_ = false;
  const glm::dvec3 ball = reference.ankle_in_world +
                          reference.world_from_t_pose * foot.ball_from_ankle_in_t_pose;
  const double height_m = std::min(reference.ankle_in_world.y - foot.ankle_height_m,
                                   ball.y - foot.ball_height_m);
  if (!bears || height_m > options.max_height_legs * leg_length_m) return Mode::kFree;
  if (mode_ != Mode::kFree) {
    const glm::dvec3 away = last_place_.ankle_in_world - last_reference_.ankle_in_world;
    if (glm::length(away) > options.slip_legs * leg_length_m) slipped_ = true;
  }
  if (slipped_) return Mode::kFree;
  if (reference.heel_bears) return reference.ball_bears ? Mode::kFlat : Mode::kHeel;
  return Mode::kBall;
}

void FootHold::release(const FootHoldOptions& options) {
  displacement_.value = place_motion_.value - reference_motion_.value;
  displacement_.rate = place_motion_.rate - reference_motion_.rate;
  displacement_.acceleration =
      place_motion_.acceleration - reference_motion_.acceleration;
  fade_s_ = options.release_s;
}

void FootHold::stand(const glm::dvec3& p_in_world,
                     const glm::dvec3& velocity_m_s,
                     double height_m,
                     const FootHoldOptions& options) {
  stands_in_world_ = p_in_world + (kStopShare * options.brake_s) * velocity_m_s;
  stands_in_world_.y = height_m;
  displacement_ = {p_in_world - stands_in_world_, velocity_m_s, glm::dvec3(0.0)};
  fade_s_ = options.brake_s;
}

void FootHold::change(Mode mode,
                      const retarget::FootMap& foot,
                      const FootHoldOptions& options) {
  const glm::dquat& rotation = last_place_.world_from_t_pose;
  if (mode == Mode::kFree) {
    release(options);
  } else if (mode == Mode::kBall) {
    const glm::dvec3 ball = rotation * foot.ball_from_ankle_in_t_pose;
    stand(last_place_.ankle_in_world + ball,
          place_motion_.rate + glm::cross(place_spin_rad_s_, ball),
          foot.ball_height_m,
          options);
  } else if (mode_ != Mode::kHeel && mode_ != Mode::kFlat) {
    stand(last_place_.ankle_in_world, place_motion_.rate, foot.ankle_height_m, options);
  }
  // Otherwise heel and flat foot stand on the same point.
  if (mode == Mode::kFlat) {
    const glm::dvec3 onward = (kStopShare * options.brake_s) * place_spin_rad_s_;
    stands_rotation_ = glm::normalize(rotation_by(onward) * rotation);
    turn_ = {-onward, place_spin_rad_s_, glm::dvec3(0.0)};
  } else {
    // The yaw that a standing foot has kept stays; the rest fades.
    const glm::dquat& from = last_reference_.world_from_t_pose;
    held_yaw_rad_ = mode == Mode::kFree ? 0.0 : yaw_of(rotation * glm::conjugate(from));
    turn_ = {turn_between(about_vertical(held_yaw_rad_) * from, rotation),
             place_spin_rad_s_ - reference_spin_rad_s_ +
                 glm::dvec3(0.0, mode == Mode::kFree ? 0.0 : steered_rad_s_, 0.0),
             glm::dvec3(0.0)};
  }
  mode_ = mode;
  since_change_s_ = 0.0;
}

void FootHold::fade_turn(const FootReference& reference, double step_s) {
  if (mode_ != Mode::kFree || !reference.landing || !reference.landing->is_flat ||
      slipped_) {
    fade(turn_, {}, fade_s_ - since_change_s_, step_s);
    return;
  }
  const FootReference::Landing& landing = *reference.landing;
  Motion2<glm::dvec3> end;
  end.value = landing.turn_rad;
  end.rate = -landing.spin_rad_s;
  fade(turn_, end, landing.in_s + step_s, step_s);
}

glm::dvec3 FootHold::free_ankle(const FootReference& reference,
                                const retarget::FootMap& foot,
                                double step_s) {
  if (!reference.landing || slipped_) {
    fade(displacement_, {}, fade_s_ - since_change_s_, step_s);
    return reference.ankle_in_world + displacement_.value;
  }
  const FootReference::Landing& landing = *reference.landing;
  Motion2<glm::dvec3> end;
  end.value = landing.shift_in_world;
  end.value.y = foot.ankle_height_m - landing.ankle_in_world.y;
  end.rate = -landing.velocity_m_s;
  // The landing is this long after the present step; the state is one step old.
  fade(displacement_, end, landing.in_s + step_s, step_s);
  since_change_s_ = std::min(since_change_s_, 0.5 * fade_s_);
  return reference.ankle_in_world + displacement_.value;
}

void FootHold::observe(const FootReference& reference,
                       const Place& place,
                       double step_s) {
  const auto follow = [&](Motion2<glm::dvec3>& motion, const glm::dvec3& now) {
    const glm::dvec3 rate = (now - motion.value) / step_s;
    motion.acceleration = is_known_ ? (rate - motion.rate) / step_s : glm::dvec3(0.0);
    motion.rate = rate;
    motion.value = now;
  };
  if (!is_known_) {
    reference_motion_.value = reference.ankle_in_world;
    place_motion_.value = place.ankle_in_world;
  } else {
    reference_spin_rad_s_ =
        turn_between(last_reference_.world_from_t_pose, reference.world_from_t_pose) /
        step_s;
    place_spin_rad_s_ =
        turn_between(last_place_.world_from_t_pose, place.world_from_t_pose) / step_s;
  }
  follow(reference_motion_, reference.ankle_in_world);
  follow(place_motion_, place.ankle_in_world);
  last_reference_ = {reference.ankle_in_world, reference.world_from_t_pose};
  last_place_ = place;
  is_known_ = true;
}

FootHold::Place FootHold::step(const FootReference& reference,
                               const retarget::FootMap& foot,
                               double leg_length_m,
                               double step_s,
                               const FootHoldOptions& options) {
  MAREY_ASSERT(step_s > 0.0);
  const Mode mode = mode_of(reference, foot, leg_length_m, options);
  if (!is_known_) {
    // A foot that bears from the start stands where it is.
    last_place_ = {reference.ankle_in_world, reference.world_from_t_pose};
    last_reference_ = last_place_;
    place_motion_.value = reference.ankle_in_world;
    reference_motion_.value = reference.ankle_in_world;
  }
  steered_rad_s_ = reference.steered_rad / step_s;
  if (mode != mode_) change(mode, foot, options);
  fade_turn(reference, step_s);
  if (mode_ == Mode::kHeel || mode_ == Mode::kBall) {
    held_yaw_rad_ -= reference.steered_rad;
  }
  Place place;
  place.world_from_t_pose =
      glm::normalize(rotation_by(turn_.value) *
                     (mode_ == Mode::kFlat
                          ? stands_rotation_
                          : about_vertical(held_yaw_rad_) * reference.world_from_t_pose));
  if (mode_ == Mode::kFree) {
    place.ankle_in_world = free_ankle(reference, foot, step_s);
  } else {
    fade(displacement_, {}, fade_s_ - since_change_s_, step_s);
    place.ankle_in_world = stands_in_world_ + displacement_.value;
    if (mode_ == Mode::kBall) {
      place.ankle_in_world -= place.world_from_t_pose * foot.ball_from_ankle_in_t_pose;
    }
  }
  since_change_s_ += step_s;
  observe(reference, place, step_s);
  return place;
}

}  // namespace marey::engine
