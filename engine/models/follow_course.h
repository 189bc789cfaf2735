// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::engine {

struct FollowSettings {
  double max_acceleration_m_s2 = 25.0;
  double max_speed_m_s = 4.0;
  /// The acceleration changes at most this fast: it is continuous. [m/s^3]
  double max_jerk_m_s3 = 1500.0;
};

/// State of a followed point in the world.
struct FollowState {
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 velocity_m_s{0.0};
  glm::dvec3 acceleration_m_s2{0.0};
  double behind_m = 0.0;  ///< Distance to the target as it was given.
};

/// A hand follows a live point (7.5). Place and velocity are continuous and the
/// acceleration is, too, and bounded; the target's own velocity is followed, so that a
/// point at constant speed is followed without delay after a time that the bounds give.
/// Same inputs, same bytes; allocates nothing; below 0.1 us a step.
class FollowCourse {
 public:
  /// Begins at a place with a velocity. Errors (bad input): not finite; settings <= 0.
  [[nodiscard]] Status start(const glm::dvec3& p_in_world,
                             const glm::dvec3& velocity_m_s,
                             const FollowSettings& settings = {});

  /// Moves one step towards the target of the end of this step. A target that is not
  /// finite is lost: the motion is braked within the bounds.
  /// Precondition: started; step_s > 0.
  const FollowState& step(const glm::dvec3& target_in_world, double step_s);

  [[nodiscard]] const FollowState& state() const { return state_; }

 private:
  FollowSettings settings_;
  FollowState state_;
  glm::dvec3 target_in_world_{0.0};
  glm::dvec3 target_velocity_m_s_{0.0};
  int seen_ = 0;
};

}  // namespace marey::engine
