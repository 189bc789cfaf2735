// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the joint refinement behind every calibration.

#include <functional>
#include <optional>
#include <vector>

#include "calib/expected_error.h"
#include "calib/rig_model.h"

namespace marey::calib {

/// What a refinement moves, beside targets.
struct RefineOptions {
  bool intrinsics = true;
  /// Per camera: its lens is known and does not move. Empty: none is.
  std::vector<bool> held_lenses;
  bool camera_poses = true;
  bool shrinkage = false;  ///< Of tags.
  bool offsets = false;    ///< Of the clocks of all cameras but the first.
  bool drifts = false;     ///< Likewise.
  bool line_delays = false;
  /// The camera that does not move. Nullopt: the target that stays holds the world.
  std::optional<std::size_t> fixed_camera;
  /// A motion between knots bends this much without good reason (smooth targets).
  double acceleration_m_s2 = 15.0;
  double acceleration_rad_s2 = 60.0;
  bool covariance = true;
  /// For comparisons: as coarse as the robust pass, of at most 40 iterations.
  bool quick = false;
  /// Called after each of the solver's iterations. May be empty.
  std::function<void()> on_iteration;
};

/// Standard deviations beside those of RigCovariance.
struct ClockSigma {
  double offset_s = 0.0;
  double drift = 0.0;
  double line_delay_s = 0.0;
};

struct RigDoubt {
  RigCovariance covariance;
  std::vector<ClockSigma> clocks;  ///< Per camera.
  /// By how much all doubts are larger than independent corners with the sigmas that
  /// their detector claims would leave: residuals may be larger than they say, and a
  /// small part of a corner's error is common to all of a camera's corners, however many.
  double sigma_factor = 1.0;
};

/// Minimises the reprojection of all sightings over cameras, targets and what the options
/// name. First robustly (Cauchy at five sigmas of a tag, three of a point); then
/// sightings that stay far off, compared with the others of their camera, are marked as
/// outliers and left out of a plain least-squares refinement of the rest. Weak priors
/// keep what a recording does not show at its usual value (bundle_priors.h). Sightings of
/// no known pose, or behind their camera at the start, are marked as outliers from the
/// beginning.
///
/// nullopt when the solver finds no minimum, or one that leaves a camera free to move.
/// One thread, one order of summation: the same bytes every time.
[[nodiscard]] std::optional<RigDoubt> refine_rig(RigModel& model,
                                                 const RefineOptions& options);

}  // namespace marey::calib
