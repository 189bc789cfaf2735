// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::engine {

struct FollowSettings {
  double max_acceleration_m_s2 = 25.0;
  double max_speed_m_s = 4.0;
  double max_jerk_m_s3 = 1500.0;
  /// Horizon of the shortest plan: a deviation of the target decays within it. [s]
  double shortest_s = 0.12;
};

/// State of a point that follows.
struct FollowState {
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 velocity_m_s{0.0};
  glm::dvec3 acceleration_m_s2{0.0};
  double behind_m = 0.0;  ///< Distance to the last target that was given.
};

/// A hand follows a live point (engine.md 7.5). Each step plans the quintic from the
/// current place, velocity and acceleration to the moving target, in the shortest time in
/// which it keeps the bounds of acceleration and speed, and moves along it by one step.
/// Place, velocity and acceleration are continuous. A target at constant velocity is
/// followed without delay once it has been reached.
/// Same inputs, same bytes; allocates nothing; below 1 us a step.
class FollowCourse {
 public:
  /// Begins at a place with a velocity. Errors (bad input): not finite; settings <= 0.
  [[nodiscard]] Status start(const glm::dvec3& p_in_world,
                             const glm::dvec3& velocity_m_s,
                             const FollowSettings& settings = {});

  /// Moves by one step. `target_in_world`: place of the target at the end of the step. A
  /// target that is not finite is lost: the point stops within the bounds.
  /// Precondition: started; step_s > 0.
  const FollowState& step(const glm::dvec3& target_in_world, double step_s);

  [[nodiscard]] const FollowState& state() const { return state_; }

 private:
  FollowSettings settings_;
  FollowState state_;
  glm::dvec3 target_in_world_{0.0};
  glm::dvec3 target_velocity_m_s_{0.0};
  int seen_ = 0;  ///< Targets in a row, at most 2.
};

}  // namespace marey::engine
