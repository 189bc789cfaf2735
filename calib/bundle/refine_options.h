// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: options of the joint refinement, and the uncertainty of its result.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "calib/model/rig_covariance.h"

namespace marey::calib {

/// Parameters that a refinement moves, in addition to the targets.
struct RefineOptions {
  bool intrinsics = true;
  /// Per camera: its lens is known and held fixed. Empty: none is known.
  std::vector<bool> held_lenses;
  bool camera_poses = true;
  bool shrinkage = false;  ///< Of tags.
  bool offsets = false;    ///< Clock offsets of all cameras but the first.
  bool drifts = false;     ///< Clock drifts of all cameras but the first.
  bool line_delays = false;
  /// The camera that is held. nullopt: the static target fixes the world.
  std::optional<std::size_t> fixed_camera;
  /// Sigma of the acceleration between knots (smooth targets).
  double acceleration_m_s2 = 15.0;
  double acceleration_rad_s2 = 60.0;
  bool covariance = true;
  /// For comparisons: the accuracy of the robust pass, and at most 40 iterations.
  bool quick = false;
  /// Called after each of the solver's iterations. May be empty.
  std::function<void()> on_iteration;
};

/// Standard deviations that are not part of RigCovariance.
struct ClockSigma {
  double offset_s = 0.0;
  double drift = 0.0;
  double line_delay_s = 0.0;
};

struct RigUncertainty {
  RigCovariance covariance;
  std::vector<ClockSigma> clocks;  ///< Per camera.
  /// Ratio of all standard deviations to those of independent corners with the detector's
  /// sigmas. Residuals may be larger than these sigmas, and a small part of a corner's
  /// error is common to all corners of a camera.
  double sigma_factor = 1.0;
};

}  // namespace marey::calib
