// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "calib/expected_error.h"
#include "calib/plan_rig.h"
#include "core/board.h"
#include "core/camera_quality.h"
#include "core/result.h"

namespace marey::calib {

/// How well planned cameras will be known: the covariance that calibrate_cameras() gives
/// for them when `board` is waved through the grid's volume, 90 frames in two rounds,
/// then lies in its middle on the floor. Corners are exact and claim `corner_sigma`; tags
/// that face away, are too small or not whole in a picture are not seen.
///
/// The covariance has the axes of the given cameras' world. Errors are relative to where
/// the board lies; when it cannot be read there, to the first camera, which then has
/// none. Errors (kBadInput): as calibrate_cameras(), when these cameras cannot be
/// calibrated so; `next` says what to change in the plan. Cost: some seconds.
/// Precondition: one camera or more.
[[nodiscard]] Result<RigCovariance> plan_calibration(std::span<const Camera> cameras,
                                                     const ErrorMapGrid& grid,
                                                     const AprilGrid& board,
                                                     const CornerSigma& corner_sigma,
                                                     const PlanOptions& options);

/// Stretches each camera's part of the covariance so that its centre's standard deviation
/// is what `quality` says; of cameras of which it says nothing (0), it stays.
/// Precondition: one quality per camera.
void fit_to_quality(std::span<const CameraQuality> quality, RigCovariance& covariance);

/// The covariance of cameras of which nothing but `quality` is known: each errs by
/// itself, in its place and its focal lengths. Attitudes, and cameras of which it says
/// nothing, are then exact, which is more than anybody knows.
[[nodiscard]] RigCovariance covariance_of_quality(std::span<const CameraQuality> quality);

/// Standard deviation of a camera's centre, root mean square over coordinates. [m]
[[nodiscard]] double centre_sigma_m(const RigCovariance& covariance, std::size_t camera);

}  // namespace marey::calib
