// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "calib/model/expected_error.h"
#include "core/base/ids.h"
#include "core/camera.h"
#include "core/camera_quality.h"
#include "core/transform.h"

namespace marey::calib {

/// Outlier sightings of one camera in one frame.
struct OutlierFrame {
  CameraId camera{};
  int frame = 0;      ///< kFloorInstant (calib/model/board_views.h) for static targets.
  int sightings = 0;  ///< Tags (or points) excluded from the last refinement.
  int seen = 0;       ///< Tags (or points) seen in that frame.
  double median_error_px = 0.0;  ///< Median error of the excluded sightings.
};

/// A camera's clock: a frame at time t of the camera's clock was exposed at t * (1 +
/// drift) + offset on the first camera's clock.
struct SolvedClock {
  double offset_s = 0.0;
  double offset_sigma_s = 0.0;
  double drift = 0.0;
  double drift_sigma = 0.0;
  double line_delay_s = 0.0;  ///< From one row of the image to the next.
  double line_delay_sigma_s = 0.0;
};

/// Errors of a calibration on held-out data.
struct CrossValidation {
  /// RMS error of a calibration from the even frames, on these frames.
  double seen_rms_px = 0.0;
  /// The same on the odd frames. Outliers are excluded from both.
  double held_out_rms_px = 0.0;
  /// Per camera: distance of its centres in calibrations from the even and from the odd
  /// frames. Errors common to both (the print, shortcomings of the lens model) are not
  /// included.
  std::vector<double> centre_apart_m;
  std::vector<double> turn_apart_rad;
  std::vector<double> focal_apart_px;
  /// Distance of each camera's centres in calibrations from the first and second half of
  /// the recording in time, and its expectation from both halves' covariances. Empty if a
  /// half has too few data.
  std::vector<double> time_apart_m;
  std::vector<double> time_expected_m;
  /// Per camera: median error of its sightings if the board's poses are computed from the
  /// other cameras alone; nullopt if it shares no views.
  std::vector<std::optional<double>> held_out_camera_px;
};

/// A corner of the board, or of a tag of the wand, in one camera. Single precision: there
/// may be a million corners, and they are only displayed.
struct SeenCorner {
  glm::vec2 seen_px{0.0F};   ///< Seen pixel, common shrinkage of tags corrected.
  glm::vec2 error_px{0.0F};  ///< Seen minus expected.
  bool is_outlier = false;   ///< Excluded from the last refinement.
};

/// Corners of one target in one frame of one camera, and the target's pose at that time.
struct TargetView {
  CameraId camera{};
  int frame = 0;       ///< kFloorInstant (calib/model/board_views.h) for static targets.
  int target = 0;      ///< Index; one camera and frame may have views of several targets.
  bool stays = false;  ///< The board on the floor, or the static tags around a wand.
  /// At the time of the sighting. z is out of a board's face.
  RigidTransform world_from_target;
  std::vector<SeenCorner> corners;
};

/// Estimated line delays of cameras that were refined without a rolling shutter, to first
/// order.
struct ApparentLineDelays {
  std::vector<double> delay_s;  ///< Per camera, from one row to the next.
  std::vector<double> sigma_s;
  /// Per camera, shift of its centre if delays were solved for. [m]
  std::vector<double> shift_m;
  double gain = 0.0;  ///< Reduction of the cost, in squared sigmas.
};

/// Estimated move of a camera during the recording.
struct ApparentMove {
  CameraId camera{};
  /// First frame after the move; nullopt: between the waved and the floor trial.
  std::optional<int> from_frame;
  double moved_px = 0.0;  ///< Effect on the camera's sightings, root mean square.
  double turn_rad = 0.0;
  double shift_m = 0.0;
  double gain = 0.0;  ///< Reduction of the cost, in squared sigmas.
  /// Other cameras whose move would reduce the cost nearly as much.
  std::vector<CameraId> alternatives;
  /// Largest shift of a camera's centre if the move is solved for [m]: the effect on the
  /// calibration. It may be large for a move of few pixels (a drifting focal length looks
  /// like a small move).
  double rig_shift_m = 0.0;
};

/// A camera with two possible poses, because its shared views have two planar pose
/// solutions.
struct AmbiguousCamera {
  CameraId camera{};
  int instants = 0;      ///< Instants shared with other cameras.
  double apart_m = 0.0;  ///< Distance between the two possible centres.
  double rms_px = 0.0;   ///< Error at those instants for the reported pose.
  double other_rms_px = 0.0;
};

/// Calibrated cameras and their uncertainty.
struct CalibratedRig {
  std::vector<Camera> cameras;
  std::vector<CameraQuality> quality;  ///< Per camera.
  double rms_px = 0.0;                 ///< Over all corners of all cameras.
  /// Median distance over all corners; robust against a few wrong tags.
  double median_px = 0.0;
  double inlier_rms_px = 0.0;  ///< Over the inliers of the last refinement.
  int sightings = 0;           ///< Tags, or points of boards without tags.
  int outliers = 0;            ///< Sightings excluded from the last refinement.
  std::vector<OutlierFrame> outlier_frames;  ///< Worst first.
  RigCovariance covariance;
  /// Factor of the covariance and of every sigma over those of independent corners with
  /// the detector's sigmas: corner errors may be larger, and a small part of them is
  /// common to all sightings of a camera. At least 1.
  double sigma_factor = 1.0;
  std::vector<SolvedClock> clocks;  ///< Per camera; zeros if clocks were not solved for.
  /// Set if it was requested and both halves of the recording have enough data.
  std::optional<CrossValidation> cross_validation;
  /// Warp of the board: the rise out of its plane towards its edges along x and y, and
  /// its twist [m]; nullopt if the data do not determine it.
  std::optional<std::array<double, 3>> warp_m;
  /// Every sighting with a pose, ordered by camera, frame and target; about 20 bytes per
  /// corner.
  std::vector<TargetView> views;
  /// nullopt if line delays were solved for or are not observable.
  std::optional<ApparentLineDelays> apparent_line_delays;
  /// The most likely move, however small; nullopt without evidence.
  std::optional<ApparentMove> apparent_move;
  std::optional<AmbiguousCamera> ambiguous;
  /// Number of instants at which cameras a and b saw the moving board (or wand) together:
  /// [a * cameras + b]. [a * cameras + a] is the number of instants at which a saw it.
  std::vector<int> shared_views;
};

}  // namespace marey::calib
