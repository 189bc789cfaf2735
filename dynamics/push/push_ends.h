// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace marey::dynamics {

inline constexpr double kStandardGravity_m_s2 = 9.81;

/// Height and vertical velocity of the centre of mass at both ends of a support: a push
/// from a start to take-off, a landing from touch-down to rest, or both in a run. World Y
/// is up. Times count from the start.
struct PushEnds {
  double start_m = 0.0;
  double start_m_s = 0.0;
  double end_m = 0.0;
  double end_m_s = 0.0;
  double duration_s = 0.0;  ///< Above 0.
  /// Accelerations; nullopt: free (force law), or zero (thesis law). The force per
  /// kilogram is the acceleration plus gravity.
  std::optional<double> start_m_s2{};
  std::optional<double> end_m_s2{};
  double gravity_m_s2 = kStandardGravity_m_s2;  ///< Above 0.
};

}  // namespace marey::dynamics
