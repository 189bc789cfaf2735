// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib/model/board_views.h"
#include "calib/model/calibrated_rig.h"
#include "core/board.h"
#include "core/finding.h"

namespace marey::calib {

/// Attitude of the board in one view. Lens parameters are observable if it varies.
struct ViewTilt {
  double tilt_rad = 0.0;  ///< Angle of its face out of the plane of the image.
  /// Direction of the tilt in the image: 0 right, pi / 2 down.
  double azimuth_rad = 0.0;
  double distance_m = 0.0;  ///< From the camera to its middle.
};

/// Delay of a camera relative to the others, estimated from the correlation of its errors
/// with the board's motion in its image. Positive: it is later.
struct CameraLag {
  double frames = 0.0;
  double sigma_frames = 0.0;
  double explained_px = 0.0;  ///< Root mean square of the errors that the lag explains.
};

/// A camera whose lag changes during the recording: its video skips or repeats frames.
struct CameraSlip {
  int from_frame = 0;
  double frames = 0.0;    ///< Increase of its lag from that frame on.
  double moved_px = 0.0;  ///< Motion of the board in that time, root mean square.
};

inline constexpr int kCoverageColumns = 16;
inline constexpr int kCoverageRows = 12;

/// Measures of one camera's sightings.
struct CameraMeasures {
  double inlier_rms_px = 0.0;  ///< Over the inliers of the last refinement.
  double median_px = 0.0;      ///< Over all corners.
  int outlier_corners = 0;
  int instants = 0;  ///< With a view of the moving board.
  /// Number of corners per image cell, row by row from the top left.
  std::array<int, std::size_t{kCoverageColumns} * kCoverageRows> cells{};
  /// Share of the 8 x 6 cells of CameraQuality::coverage with a corner, in the left,
  /// right, upper and lower half.
  std::array<double, 4> half_coverage{};
  std::vector<ViewTilt> tilts;  ///< Views of the moving board; empty for a wand.
  double p90_tilt_rad = 0.0;
  /// Root mean square of the mean errors over areas of the image, minus the part expected
  /// by chance: the systematic error that the lens model leaves. [px]
  double pattern_px = 0.0;
  /// Estimated only if the calibration uses one clock for all cameras.
  std::optional<CameraLag> lag;
  std::optional<CameraSlip> slip;  ///< Set if the lag changes significantly.
  /// Median error of the views of the floor board or of static tags; nullopt without any.
  std::optional<double> floor_median_px;
  /// First frame after which almost all sightings are outliers.
  std::optional<int> mismatch_from;
  /// Last frame before which almost all sightings are outliers.
  std::optional<int> mismatch_until;
};

/// Expected errors of a point in the volume.
struct CalibrationMap {
  ErrorMapGrid grid;
  std::vector<std::string> height_names;  ///< Names of the grid's heights: "ankle"...
  std::vector<ErrorMapPlace> places;
  glm::dvec3 middle_in_world{0.0};  ///< Middle of the volume, at the middle height.
  double distance_m = 0.0;          ///< Median distance of the cameras from there.
  /// The largest error over the heights at the middle; nullopt if fewer than two cameras
  /// see it.
  std::optional<double> middle_error_m;
};

/// All measures of a calibration that its findings and its page use.
struct CalibrationReport {
  std::string session;
  std::string version;
  std::string target;  ///< name_of() the target that was shown to the cameras.
  std::optional<BoardExtent> extent;  ///< Extent of a board; nullopt for a wand.
  double stature_m = 1.75;
  double rate_hz = 0.0;         ///< Rate of the first camera.
  bool has_floor = false;       ///< The world's ground, y = 0, is the floor.
  bool board_on_floor = false;  ///< The board was seen lying there.
  bool has_clocks = false;      ///< Clocks were solved for.
  CalibratedRig rig;
  /// Per coordinate, from the residuals of the calibration.
  double corner_sigma_px = 0.0;
  std::vector<CameraMeasures> cameras;
  CalibrationMap map;
  std::vector<Finding> findings;  ///< Worst first.
};

}  // namespace marey::calib
