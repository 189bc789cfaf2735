// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "dynamics/push/push_ends.h"

namespace marey::dynamics {

/// Moments of a force that ends require: its impulse, and its impulse of the remaining
/// time (height gained without the start's velocity).
struct PushMoments {
  double impulse_m_s = 0.0;     ///< m0 = integral of f.
  double first_moment_m = 0.0;  ///< m1 = integral of (T - t) f.
};
[[nodiscard]] PushMoments push_moments(const PushEnds& ends);

/// Reason for which no force from 0 to a limit has the moments.
enum class PushObstacle {
  kNone,        ///< Such a force exists.
  kPullDown,    ///< Gravity alone is too slow: m0 <= 0.
  kEndTooLow,   ///< The impulse, as late as possible, gains more height: m1 is small.
  kEndTooHigh,  ///< The impulse, as early as possible, gains less: m1 is large.
  kStrength,    ///< The impulse needs more than the largest force all the time.
};

/// Decides in closed form. Without a limit a force exists if and only if m0 > 0 and
/// 0 < m1 < T m0. With the largest force F: m0 <= F T and
/// m0^2 / (2F) <= m1 <= T m0 - m0^2 / (2F), the moments of F applied as late and as early
/// as possible. Precondition: duration_s above 0, max_force_m_s2 above 0.
[[nodiscard]] PushObstacle find_obstacle(
    const PushMoments& moments,
    double duration_s,
    std::optional<double> max_force_m_s2 = std::nullopt);
/// Returns true if find_obstacle() finds no obstacle.
[[nodiscard]] bool is_reachable(const PushMoments& moments,
                                double duration_s,
                                std::optional<double> max_force_m_s2 = std::nullopt);

/// Velocities at the end of a push. The limits themselves are reached by impact-like
/// forces only; without a largest force they are not reached.
struct SpeedRange {
  double min_m_s = 0.0;
  std::optional<double> max_m_s{};  ///< nullopt: no upper limit.
};
/// Returns the end velocities that is_reachable() allows for the start, the end height
/// and the duration; `ends.end_m_s` is not used. Closed form. nullopt: no velocity is
/// reachable, since the end height is not.
[[nodiscard]] std::optional<SpeedRange> reachable_end_speeds(
    const PushEnds& ends, std::optional<double> max_force_m_s2 = std::nullopt);

}  // namespace marey::dynamics
