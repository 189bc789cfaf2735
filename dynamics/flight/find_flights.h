// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/motion.h"

namespace marey::dynamics {

/// An interval without support of the body: in a jump, between two steps of a run.
struct Flight {
  double takeoff_s = 0.0;  ///< After the first pose.
  double landing_s = 0.0;
  /// Rise of the centre of mass above its height at take-off; 0 if it only falls. A
  /// take-off detected 10 ms early adds some 2 cm. [m]
  double rise_m = 0.0;
  /// Median acceleration of the centre of mass, upwards: -9.81 without errors. [m/s^2]
  double acceleration_m_s2 = 0.0;
};

struct FindFlightsOptions {
  double min_flight_s = 0.05;
  /// Accelerations are those of parabolas fitted over this duration, and over at least
  /// five poses.
  double smoothing_s = 0.05;
};

/// Finds flights of a body from its motion alone: its centre of mass is in free fall,
/// independent of the floor's height and of the feet. Masses of the segments are those of
/// de Leva (J. Biomech. 29, 1996, table 4, men).
/// Take-off and landing lie between poses, where the acceleration nearly reaches that of
/// free fall. In a drop jump they agree with force plates to within a pose at 100 Hz; for
/// feet that leave the floor slowly, as in running, the take-off is some 20 ms early. A
/// flight that is cut by the motion's start or end is left out.
/// Sorted by time. Linear in poses. Precondition: the skeleton is one of make_humanoid();
/// the world's unit is the metre and Y is up; the rate is above 0.
[[nodiscard]] std::vector<Flight> find_flights(const Motion& motion,
                                               const FindFlightsOptions& options = {});

}  // namespace marey::dynamics
