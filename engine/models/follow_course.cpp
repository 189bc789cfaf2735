// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/follow_course.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

// Number of horizons that are tried, each longer by this factor.
constexpr int kHorizons = 24;
constexpr double kLonger = 1.16;
// Share of the newest difference in the velocity of the target.
constexpr double kNewest = 0.5;

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Quintic over [0, 1] relative to the start.
struct FollowPlan {
  double length_s = 0.0;
  glm::dvec3 v{0.0}, a{0.0}, c3{0.0}, c4{0.0}, c5{0.0};

  [[nodiscard]] glm::dvec3 moved(double x) const {
    return x * (v + x * (0.5 * a + x * (c3 + x * (c4 + x * c5))));
  }
  [[nodiscard]] glm::dvec3 velocity(double x) const {
    return (v + x * (a + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))) / length_s;
  }
  [[nodiscard]] glm::dvec3 acceleration(double x) const {
    return (a + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5))) / (length_s * length_s);
  }
};

FollowPlan follow_plan(const FollowState& from,
                       const glm::dvec3& displacement_m,
                       const glm::dvec3& end_velocity_m_s,
                       double length_s) {
  FollowPlan plan;
  plan.length_s = length_s;
  plan.v = from.velocity_m_s * length_s;
  plan.a = from.acceleration_m_s2 * (length_s * length_s);
  const glm::dvec3 d = displacement_m - plan.v - 0.5 * plan.a;
  const glm::dvec3 e = end_velocity_m_s * length_s - plan.v - plan.a;
  plan.c3 = 10.0 * d - 4.0 * e - 0.5 * plan.a;
  plan.c4 = -15.0 * d + 7.0 * e + plan.a;
  plan.c5 = 6.0 * d - 3.0 * e - 0.5 * plan.a;
  return plan;
}

bool keeps_bounds(const FollowPlan& plan, const FollowSettings& settings) {
  for (const double x : {0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9}) {
    if (glm::length(plan.acceleration(x)) > settings.max_acceleration_m_s2) return false;
    if (glm::length(plan.velocity(x)) > settings.max_speed_m_s) return false;
  }
  return true;
}

glm::dvec3 at_most(const glm::dvec3& v, double max_length) {
  const double length = glm::length(v);
  return length > max_length ? v * (max_length / length) : v;
}

}  // namespace

Status FollowCourse::start(const glm::dvec3& p_in_world,
                           const glm::dvec3& velocity_m_s,
                           const FollowSettings& settings) {
  if (!is_finite(p_in_world) || !is_finite(velocity_m_s)) {
    return bad_input("follow",
                     "the place or velocity of the hand is not a finite number",
                     "give both in metres and metres per second");
  }
  const auto is_positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!is_positive(settings.max_acceleration_m_s2) ||
      !is_positive(settings.max_speed_m_s) || !is_positive(settings.max_jerk_m_s3) ||
      !is_positive(settings.shortest_s)) {
    return bad_input(
        "follow", "a bound of the motion is not positive", "give positive bounds");
  }
  *this = {};
  settings_ = settings;
  state_.p_in_world = p_in_world;
  state_.velocity_m_s = velocity_m_s;
  target_in_world_ = p_in_world;
  return Done{};
}

const FollowState& FollowCourse::step(const glm::dvec3& target_in_world, double step_s) {
  MAREY_ASSERT(step_s > 0.0);
  const bool is_seen = is_finite(target_in_world);
  if (is_seen) {
    const glm::dvec3 newest = (target_in_world - target_in_world_) / step_s;
    const double share = seen_ == 1 ? 1.0 : kNewest;
    if (seen_ == 0) {
      target_velocity_m_s_ = {0.0, 0.0, 0.0};
    } else {
      target_velocity_m_s_ += share * (newest - target_velocity_m_s_);
    }
    // A target that jumps has no velocity.
    target_velocity_m_s_ = at_most(target_velocity_m_s_, settings_.max_speed_m_s);
    target_in_world_ = target_in_world;
    seen_ = std::min(seen_ + 1, 2);
  } else {
    seen_ = 0;
  }
  const glm::dvec3 end_velocity = is_seen ? target_velocity_m_s_ : glm::dvec3{0.0};
  const glm::dvec3 way = target_in_world - state_.p_in_world;
  double length_s = std::max(settings_.shortest_s, 2.0 * step_s);
  FollowPlan plan;
  for (int i = 0; i < kHorizons; ++i, length_s *= kLonger) {
    // The target is known for the end of this step.
    const glm::dvec3 displacement = is_seen ? way + end_velocity * (length_s - step_s)
                                            : state_.velocity_m_s * (0.5 * length_s);
    plan = follow_plan(state_, displacement, end_velocity, length_s);
    if (keeps_bounds(plan, settings_)) break;
  }
  const double x = step_s / plan.length_s;
  const glm::dvec3 planned = plan.acceleration(x);
  const glm::dvec3 change = planned - state_.acceleration_m_s2;
  const glm::dvec3 allowed = at_most(
      state_.acceleration_m_s2 + at_most(change, settings_.max_jerk_m_s3 * step_s),
      settings_.max_acceleration_m_s2);
  const glm::dvec3 mean =
      (2.0 * state_.acceleration_m_s2 + allowed) * (step_s * step_s / 6.0);
  if (allowed == planned) {
    state_.p_in_world += plan.moved(x);
    state_.velocity_m_s = plan.velocity(x);
  } else {
    state_.p_in_world += state_.velocity_m_s * step_s + mean;
    state_.velocity_m_s += 0.5 * (state_.acceleration_m_s2 + allowed) * step_s;
  }
  state_.acceleration_m_s2 = allowed;
  if (is_seen) state_.behind_m = glm::length(target_in_world_ - state_.p_in_world);
  return state_;
}

}  // namespace marey::engine
