// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "calib/expected_error.h"
#include "core/camera.h"
#include "core/camera_quality.h"
#include "core/ids.h"
#include "core/transform.h"

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
  /// Likewise of the first half of the recording in time and the second: the distance of
  /// the centres, and its expectation by both halves' covariances. Empty where a half
  /// says too little.
  std::vector<double> time_apart_m;
  std::vector<double> time_expected_m;
  /// Per camera: median error of its sightings when the board's places come from the
  /// other cameras alone; nullopt when it shares none.
  std::vector<std::optional<double>> held_out_camera_px;
};

/// A corner of the board, or of a tag of the wand, as a camera saw it. Single precision:
/// there may be a million of them, and nothing is computed from them any more.
struct SeenCorner {
  glm::vec2 seen_px{0.0F};   ///< Where, common shrinkage of tags taken off.
  glm::vec2 error_px{0.0F};  ///< Seen less expected.
  bool is_outlier = false;   ///< Left out of the last refinement.
};

/// What one camera saw of one target in one frame, and where the target was then.
struct TargetView {
  CameraId camera{};
  int frame = 0;   ///< kFloorInstant (calib/board_views.h) for what stays in all frames.
  int target = 0;  ///< Views of one camera and frame may be of several.
  bool stays = false;  ///< The board on the floor, or the scenery around a wand.
  /// As the camera met it. z is out of a board's face.
  RigidTransform world_from_target;
  std::vector<SeenCorner> corners;
};

/// A rolling shutter that the errors of cameras without one suggest, to first order.
struct ApparentLineDelays {
  std::vector<double> delay_s;  ///< Per camera, from one row to the next.
  std::vector<double> sigma_s;
  /// Per camera, how far its centre would go if delays were solved for. [m]
  std::vector<double> shift_m;
  double gain = 0.0;  ///< By how much the cost falls, in squared sigmas.
};

/// A camera that seems to have been moved during the recording.
struct ApparentMove {
  CameraId camera{};
  /// From that frame on; nullopt: between the waving and the floor trial.
  std::optional<int> from_frame;
  double moved_px = 0.0;  ///< Of what it sees, root mean square.
  double turn_rad = 0.0;
  double shift_m = 0.0;
  double gain = 0.0;  ///< By how much the cost falls, in squared sigmas.
  /// Other cameras whose move would explain nearly as much.
  std::vector<CameraId> instead;
  /// Largest shift of a camera's centre if the move is solved for [m]: the effect on the
  /// calibration, which may be large for a move of few pixels (a focal length that drifts
  /// looks like a small move).
  double rig_shift_m = 0.0;
};

/// A camera that may as well stand elsewhere: what it shares with the others reads two
/// ways.
struct AmbiguousCamera {
  CameraId camera{};
  int instants = 0;      ///< That it shares with others.
  double apart_m = 0.0;  ///< Of its two places.
  double rms_px = 0.0;   ///< Of those instants, where it stands.
  double other_rms_px = 0.0;
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
  /// When it was asked for, and both halves of the recording say enough.
  std::optional<CrossValidation> cross_validation;
  /// How far the board's plate rises out of its plane towards its edges along x and y,
  /// and twists [m]; nullopt when the data do not tell.
  std::optional<std::array<double, 3>> warp_m;
  /// Every sighting that has a place, ordered by camera, frame and target; some 20 bytes
  /// a corner.
  std::vector<TargetView> views;
  /// nullopt where line delays were solved for, or nothing tells.
  std::optional<ApparentLineDelays> apparent_line_delays;
  /// The most likely one, however small; nullopt where nothing tells.
  std::optional<ApparentMove> apparent_move;
  std::optional<AmbiguousCamera> ambiguous;
  /// At how many instants cameras a and b saw the moving board (or wand) together:
  /// [a * cameras + b], and [a * cameras + a] at how many a saw it at all.
  std::vector<int> shared_views;
};

}  // namespace marey::calib
