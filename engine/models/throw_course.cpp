// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/throw_course.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

glm::dquat world_from_heading(double heading_rad) {
  return glm::angleAxis(heading_rad, glm::dvec3(0.0, 1.0, 0.0));
}

glm::dvec3 throw_velocity(const ThrowParameters& parameters, double heading_rad) {
  return parameters.speed_m_s *
         throw_direction(heading_rad, parameters.azimuth_rad, parameters.elevation_rad);
}

Status refuse_throw(const std::string& parameter, const std::string& next) {
  return bad_input("throw", parameter + " is out of range or not a number", next);
}

}  // namespace

Status check_throw(const ThrowChanges& asked, double duration_s) {
  const auto is_wrong = [](const std::optional<double>& value, double min, double max) {
    return value && !(std::isfinite(*value) && *value >= min && *value <= max);
  };
  constexpr double kFar = 1e6;
  if (is_wrong(asked.x_m, -kFar, kFar)) return refuse_throw("x_m", "give metres");
  if (is_wrong(asked.y_m, -kFar, kFar)) return refuse_throw("y_m", "give metres");
  if (is_wrong(asked.z_m, -kFar, kFar)) return refuse_throw("z_m", "give metres");
  if (is_wrong(asked.azimuth_rad, -kFar, kFar)) {
    return refuse_throw("azimuth_rad", "give radians");
  }
  if (is_wrong(asked.elevation_rad, -glm::half_pi<double>(), glm::half_pi<double>())) {
    return refuse_throw("elevation_rad", "give radians between -pi/2 and pi/2");
  }
  if (is_wrong(asked.speed_m_s, 1e-3, kFar)) {
    return refuse_throw("speed_m_s", "give at least 0.001 m/s");
  }
  if (is_wrong(asked.release_s, 0.0, duration_s)) {
    return refuse_throw("release_s", "give a time within the clip");
  }
  return Done{};
}

ThrowParameters with_changes(const ThrowParameters& captured, const ThrowChanges& asked) {
  return {glm::dvec3(asked.x_m.value_or(captured.wrist_in_heading_m.x),
                     asked.y_m.value_or(captured.wrist_in_heading_m.y),
                     asked.z_m.value_or(captured.wrist_in_heading_m.z)),
          asked.azimuth_rad.value_or(captured.azimuth_rad),
          asked.elevation_rad.value_or(captured.elevation_rad),
          asked.speed_m_s.value_or(captured.speed_m_s),
          asked.release_s.value_or(captured.release_s)};
}

glm::dvec3 ball_place(const ThrowInstant& thrower) {
  return thrower.wrist.p_in_world +
         thrower.wrist.world_from_hand * thrower.lever_in_hand_m;
}

glm::dvec3 ball_velocity_m_s(const ThrowInstant& thrower) {
  return thrower.wrist.velocity_m_s +
         glm::cross(thrower.wrist.turn_rad_s,
                    thrower.wrist.world_from_hand * thrower.lever_in_hand_m);
}

ThrowParameters measure_throw(const ThrowInstant& at_release, double release_s) {
  const RootPlace& root = at_release.root;
  const glm::dquat heading_from_world =
      glm::conjugate(world_from_heading(root.heading_rad));
  const glm::dvec3 velocity = heading_from_world * ball_velocity_m_s(at_release);
  ThrowParameters parameters;
  parameters.wrist_in_heading_m =
      heading_from_world *
      (at_release.wrist.p_in_world - glm::dvec3(root.x_m, 0.0, root.z_m));
  const double across = std::hypot(velocity.x, velocity.z);
  parameters.azimuth_rad = across > 0.0 ? std::atan2(velocity.x, velocity.z) : 0.0;
  parameters.elevation_rad = std::atan2(velocity.y, across);
  parameters.speed_m_s = glm::length(velocity);
  parameters.release_s = release_s;
  return parameters;
}

glm::dvec3 throw_direction(double heading_rad, double azimuth_rad, double elevation_rad) {
  const double yaw = heading_rad + azimuth_rad;
  const double across = std::cos(elevation_rad);
  return {across * std::sin(yaw), std::sin(elevation_rad), across * std::cos(yaw)};
}

void ThrowCourse::start(double time_s,
                        const ThrowParameters& captured,
                        const ThrowChanges& asked,
                        double half_width_s) {
  MAREY_ASSERT(half_width_s > 0.0);
  *this = ThrowCourse{};
  wanted_ = with_changes(captured, asked);
  is_displaced_ = asked.x_m || asked.y_m || asked.z_m || asked.azimuth_rad ||
                  asked.elevation_rad || asked.speed_m_s || asked.release_s;
  half_width_s_ = half_width_s;
  time_s_ = time_s;
}

void ThrowCourse::want(const ThrowParameters& wanted) {
  wanted_ = wanted;
  is_displaced_ = true;
}

Motion3 ThrowCourse::planned(double time_s) const {
  return has_plan_ ? leg_.at(time_s) : Motion3{};
}

Motion3 ThrowCourse::wanted_displacement(const ThrowInstant& clip_at_release) const {
  const RootPlace& root = clip_at_release.root;
  Motion3 wanted;
  wanted.value = glm::dvec3(root.x_m, 0.0, root.z_m) +
                 world_from_heading(root.heading_rad) * wanted_.wrist_in_heading_m -
                 clip_at_release.wrist.p_in_world;
  wanted.rate =
      throw_velocity(wanted_, root.heading_rad) - ball_velocity_m_s(clip_at_release);
  return wanted;
}

ThrowOutput ThrowCourse::step(const ThrowInput& input) {
  MAREY_ASSERT(input.step_s > 0.0 && input.time_s >= time_s_);
  ThrowOutput output;
  double release_s = std::max(input.release_s, time_s_);
  if (is_displaced_ && !has_released_) {
    const double begin_s = std::max(release_s - half_width_s_, time_s_);
    const bool is_last =
        has_plan_ && leg_.end_s() - time_s_ <= 2.0 * input.step_s * (1.0 + 1e-6);
    if (!is_last && input.time_s > begin_s && release_s > begin_s) {
      leg_ = quintic_leg(begin_s,
                         release_s - begin_s,
                         moved_,
                         wanted_displacement(input.clip_at_release));
      has_plan_ = true;
    }
    if (has_plan_) {
      release_s = leg_.end_s();
      moved_ = leg_.at(std::min(input.time_s, release_s));
    }
  }
  if (!has_released_ && release_s <= input.time_s) {
    has_released_ = true;
    ThrowInstant thrower = input.clip_at_release;
    thrower.wrist = displaced(thrower.wrist, moved_, Motion3{});
    output.release =
        BallRelease{release_s, ball_place(thrower), ball_velocity_m_s(thrower)};
    leg_ = quintic_leg(release_s, half_width_s_, moved_, Motion3{});
  }
  if (has_released_) {
    moved_ = input.time_s < leg_.end_s() ? leg_.at(input.time_s) : Motion3{};
  }
  output.wrist = displaced(input.clip_now, moved_, Motion3{});
  output.displaced =
      is_displaced_ && has_plan_ && !(has_released_ && input.time_s >= leg_.end_s());
  output.remaining_s = release_s - input.time_s;
  if (has_released_) output.remaining_s = leg_.start_s - input.time_s;
  time_s_ = input.time_s;
  return output;
}

}  // namespace marey::engine
