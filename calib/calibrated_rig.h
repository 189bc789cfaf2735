// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "calib/expected_error.h"
#include "core/camera.h"
#include "core/camera_quality.h"
#include "core/ids.h"

namespace marey::calib {

/// What one camera saw in one frame that does not go with the rest.
struct OutlierFrame {
  CameraId camera{};
  int frame = 0;  ///< kFloorInstant (calib/board_views.h) for what stays in all frames.
  int sightings = 0;             ///< Tags (or points) left out of the last refinement.
  int of = 0;                    ///< Seen in that frame.
  double median_error_px = 0.0;  ///< Of those left out.
};

/// A camera's clock: its frame at time t of its own was exposed at t * (1 + drift) +
/// offset on the first camera's clock.
struct SolvedClock {
  double offset_s = 0.0;
  double offset_sigma_s = 0.0;
  double drift = 0.0;
  double drift_sigma = 0.0;
  double line_delay_s = 0.0;  ///< From one row of the image to the next.
  double line_delay_sigma_s = 0.0;
};

/// How a calibration fares on what it did not see.
struct CrossValidation {
  double seen_rms_px = 0.0;      ///< Of a calibration from the even frames, on these.
  double held_out_rms_px = 0.0;  ///< On the odd ones. Outliers left out of both.
  /// Per camera: cameras found from the even frames less those from the odd ones. What
  /// both share (the print, the lens model's shortcomings) does not show.
  std::vector<double> centre_apart_m;
  std::vector<double> turn_apart_rad;
  std::vector<double> focal_apart_px;
  /// Per camera: median error of its sightings when the board's places come from the
  /// other cameras alone; nullopt when it shares none.
  std::vector<std::optional<double>> held_out_camera_px;
};

/// Cameras, and how sure we are of them.
struct CalibratedRig {
  std::vector<Camera> cameras;
  std::vector<CameraQuality> quality;  ///< Per camera.
  double rms_px = 0.0;                 ///< Over all corners of all cameras.
  double median_px = 0.0;  ///< Likewise the median distance: a few wrong tags leave it.
  double inlier_rms_px = 0.0;  ///< Over what the last refinement took.
  int sightings = 0;           ///< Tags, or points of boards without tags.
  int outliers = 0;            ///< Of them, left out of the last refinement.
  std::vector<OutlierFrame> outlier_frames;  ///< Worst first.
  RigCovariance covariance;
  /// By how much the covariance and every sigma are larger than independent corners, with
  /// the sigmas that their detector claims, would leave: corners may stray further, and a
  /// small part of their error is common to all that a camera sees. At least 1.
  double sigma_factor = 1.0;
  std::vector<SolvedClock> clocks;  ///< Per camera; zeros where they were not solved for.
  std::optional<CrossValidation> cross_validation;  ///< When it was asked for.
  /// How far the board's plate rises out of its plane towards its edges along x and y,
  /// and twists [m]; nullopt when the data do not tell.
  std::optional<std::array<double, 3>> warp_m;
};

}  // namespace marey::calib
