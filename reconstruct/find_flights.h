// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/motion.h"

namespace marey::reconstruct {

/// A time during which nothing bears the body: in a jump, between two steps of a run.
struct Flight {
  double takeoff_s = 0.0;  ///< From the first pose on.
  double landing_s = 0.0;
  /// How far the centre of mass rises above where it was at take-off; 0 when it only
  /// falls. Take-off found 10 ms early adds some 2 cm. [m]
  double rise_m = 0.0;
  /// Of the centre of mass, upwards, the median: -9.81 when everything is right. [m/s^2]
  double acceleration_m_s2 = 0.0;
};

struct FindFlightsOptions {
  double shortest_s = 0.05;
  /// Accelerations are those of parabolas fitted over this long, and over five poses at
  /// least.
  double smoothing_s = 0.05;
};

/// Finds when a body flies from its motion alone: its centre of mass falls freely then,
/// wherever the floor is, and whatever the feet do. Masses of the segments are those of
/// de Leva (J. Biomech. 29, 1996, table 4, men).
///
/// Take-off and landing lie between poses, where the acceleration nearly reaches that of
/// free fall. In a drop jump they are those of force plates to within a pose at 100 Hz;
/// feet that leave the floor slowly, as in running, are taken to do so some 20 ms early.
/// A flight that the motion's start or end cuts is left out.
///
/// In order of time. Linear in poses. Precondition: the skeleton is one that
/// make_humanoid() makes; the world's unit is the metre and Y is up; the rate is above 0.
[[nodiscard]] std::vector<Flight> find_flights(const Motion& motion,
                                               const FindFlightsOptions& options = {});

}  // namespace marey::reconstruct
