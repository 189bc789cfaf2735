// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/push_reach.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace marey::dynamics {

PushMoments push_moments(const PushEnds& ends) {
  const double t = ends.duration_s;
  return {
      ends.end_m_s - ends.start_m_s + ends.gravity_m_s2 * t,
      ends.end_m - ends.start_m - ends.start_m_s * t + 0.5 * ends.gravity_m_s2 * t * t};
}

PushObstacle find_obstacle(const PushMoments& moments,
                           double duration_s,
                           std::optional<double> max_force_m_s2) {
  MAREY_ASSERT(duration_s > 0.0 && (!max_force_m_s2 || *max_force_m_s2 > 0.0));
  const double m0 = moments.impulse_m_s;
  const double m1 = moments.first_moment_m;
  if (m0 <= 0.0) return PushObstacle::kPullDown;
  if (!max_force_m_s2) {
    if (m1 <= 0.0) return PushObstacle::kEndTooLow;
    if (m1 >= duration_s * m0) return PushObstacle::kEndTooHigh;
    return PushObstacle::kNone;
  }
  if (m0 > *max_force_m_s2 * duration_s) return PushObstacle::kStrength;
  const double block_m = m0 * m0 / (2.0 * *max_force_m_s2);
  if (m1 < block_m) return PushObstacle::kEndTooLow;
  if (m1 > duration_s * m0 - block_m) return PushObstacle::kEndTooHigh;
  return PushObstacle::kNone;
}

bool is_reachable(const PushMoments& moments,
                  double duration_s,
                  std::optional<double> max_force_m_s2) {
  return find_obstacle(moments, duration_s, max_force_m_s2) == PushObstacle::kNone;
}

std::optional<SpeedRange> reachable_end_speeds(const PushEnds& ends,
                                               std::optional<double> max_force_m_s2) {
  MAREY_ASSERT(ends.duration_s > 0.0 && (!max_force_m_s2 || *max_force_m_s2 > 0.0));
  const double t = ends.duration_s;
  const double m1 = push_moments(ends).first_moment_m;
  if (m1 <= 0.0) return std::nullopt;
  const double fall_m_s = ends.start_m_s - ends.gravity_m_s2 * t;
  if (!max_force_m_s2) return SpeedRange{fall_m_s + m1 / t, std::nullopt};
  const double force = *max_force_m_s2;
  const double left = t * t - 2.0 * m1 / force;
  if (left < 0.0) return std::nullopt;
  // Smaller root of T m0 - m0^2 / (2F) = m1, without cancellation.
  const double min_impulse_m_s = 2.0 * m1 / (t + std::sqrt(left));
  return SpeedRange{fall_m_s + min_impulse_m_s, fall_m_s + std::sqrt(2.0 * force * m1)};
}

}  // namespace marey::dynamics
