// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "calib/model/expected_error.h"
#include "calib/plan/plan_rig.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/camera_quality.h"

namespace marey::calib {

/// Returns the expected covariance of planned cameras: the one that calibrate_cameras()
/// gives if `board` is waved through the grid's volume, 90 frames in two rounds, then
/// lies in its middle on the floor. Corners are exact and have the sigma `corner_sigma`.
/// Tags that face away, are too small or are partly outside an image are not seen.
///
/// The covariance has the axes of the given cameras' world. Errors are relative to the
/// board on the floor; if it is not readable there, to the first camera, which then has
/// none. Errors (kBadInput): as for calibrate_cameras(), if these cameras cannot be
/// calibrated in this way; `next` describes the change to the plan. Cost: some seconds.
/// Precondition: one camera or more.
[[nodiscard]] Result<RigCovariance> plan_calibration(std::span<const Camera> cameras,
                                                     const ErrorMapGrid& grid,
                                                     const AprilGrid& board,
                                                     const CornerSigma& corner_sigma,
                                                     const PlanOptions& options);

/// Scales each camera's part of the covariance so that its centre's standard deviation is
/// that of `quality`. Cameras without a value (0) are unchanged.
/// Precondition: one quality per camera.
void fit_to_quality(std::span<const CameraQuality> quality, RigCovariance& covariance);

/// Returns the covariance of cameras for which only `quality` is known: independent
/// errors of each camera's position and focal lengths. Attitudes, and cameras without a
/// value, are taken as exact; this underestimates the errors.
[[nodiscard]] RigCovariance covariance_of_quality(std::span<const CameraQuality> quality);

/// Returns the standard deviation of a camera's centre, root mean square over
/// coordinates. [m]
[[nodiscard]] double centre_sigma_m(const RigCovariance& covariance, std::size_t camera);

}  // namespace marey::calib
