// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "calib/board_views.h"
#include "calib/calibrated_rig.h"
#include "core/board.h"
#include "core/result.h"

namespace marey::app {

enum class Severity {
  kNote,  ///< Good to know; nothing need be done.
  kFair,  ///< The cameras can be used; this would make them better.
  kPoor,  ///< The cameras should not be trusted.
};

/// What is not as it should be with a calibration, and what to do about it.
struct Finding {
  Severity severity = Severity::kNote;
  std::string kind;   ///< One word for programs: "coverage", "tilt"...
  std::string where;  ///< "camera left", "cameras left and right", "all cameras".
  std::string cause;  ///< What was measured, with its figure.
  std::string next;   ///< What to record again, and how.
};

/// The board as it lay in one view: what says how well a lens can be known.
struct ViewTilt {
  double tilt_rad = 0.0;     ///< Of its face out of the plane of the picture.
  double azimuth_rad = 0.0;  ///< Which way, in the picture: 0 right, pi / 2 down.
  double distance_m = 0.0;   ///< From the camera to its middle.
};

/// A camera whose errors point along the board's movement in its picture: it is late
/// (positive) or early against the others.
struct CameraLag {
  double frames = 0.0;
  double sigma_frames = 0.0;
  double explained_px = 0.0;  ///< Root mean square of the errors it accounts for.
};

/// A camera that goes out of step on its way: its video skips frames, or has some twice.
struct CameraSlip {
  int from_frame = 0;
  double frames = 0.0;    ///< By so much it is later (further on) from there.
  double moved_px = 0.0;  ///< What the board moves in that time, root mean square.
};

inline constexpr int kCoverageColumns = 16;
inline constexpr int kCoverageRows = 12;

/// What one camera's sightings say.
struct CameraMeasures {
  double inlier_rms_px = 0.0;  ///< Of what the last refinement took.
  double median_px = 0.0;      ///< Of all corners.
  int outlier_corners = 0;
  int instants = 0;  ///< At which it saw the moving board.
  /// Corners by place in the picture, row by row from the top left.
  std::array<int, std::size_t{kCoverageColumns} * kCoverageRows> cells{};
  /// Of the 8 x 6 cells of CameraQuality::coverage in the left, right, upper and lower
  /// half: the share with a corner.
  std::array<double, 4> half_coverage{};
  std::vector<ViewTilt> tilts;  ///< Of the moving board; empty for a wand.
  double p90_tilt_rad = 0.0;
  /// Root mean square of the errors' means over areas of the picture, as far as chance
  /// does not account for them: what the lens model leaves. [px]
  double pattern_px = 0.0;
  std::optional<CameraLag> lag;           ///< Where clocks are taken for one.
  std::optional<CameraSlip> slip;         ///< Where its lag clearly changes.
  std::optional<double> floor_median_px;  ///< Of the board on the floor, or scenery.
  std::optional<int> astray_from;         ///< From that frame on hardly anything fits.
  std::optional<int> astray_until;        ///< Likewise up to there.
};

/// Expected errors of a point in the volume.
struct CalibrationMap {
  calib::ErrorMapGrid grid;
  std::vector<std::string> height_names;  ///< Of the grid's heights: "ankle"...
  std::vector<calib::ErrorMapPlace> places;
  glm::dvec3 middle_in_world{0.0};  ///< Of the volume, at the middle height.
  double distance_m = 0.0;          ///< Of the cameras from there, median.
  /// The worst of the heights at the middle; nullopt when no two cameras see it.
  std::optional<double> middle_error_m;
};

/// What a calibration is judged and shown by.
struct CalibrationReport {
  std::string session;
  std::string version;
  std::string target;                        ///< name_of() what was shown to the cameras.
  std::optional<calib::BoardExtent> extent;  ///< Of a board; nullopt for a wand.
  double stature_m = 1.75;
  double rate_hz = 0.0;         ///< Of the first camera.
  bool has_floor = false;       ///< The world's ground, y = 0, is the floor.
  bool board_on_floor = false;  ///< The board was seen lying there.
  bool has_clocks = false;      ///< Clocks were solved for.
  calib::CalibratedRig rig;
  double corner_sigma_px = 0.0;  ///< Per coordinate, as the calibration left corners.
  std::vector<CameraMeasures> cameras;
  CalibrationMap map;
  std::vector<Finding> findings;  ///< Worst first.
};

/// Where a calibration comes from.
struct CalibrationSource {
  std::string session;
  std::string version;
  const CalibrationTarget* target = nullptr;
  double stature_m = 0.0;  ///< 0: of nobody in particular.
  double rate_hz = 0.0;    ///< Of the first camera's frames.
  /// The world's ground is the floor. A board that lay on it says so by itself.
  bool has_floor = false;
};

/// Everything about a rig that its page shows, findings too. Some 0.1 s for four cameras.
[[nodiscard]] CalibrationReport report_calibration(const CalibrationSource& source,
                                                   calib::CalibratedRig rig);

/// What calibration.json holds (docs/formats.md).
[[nodiscard]] nlohmann::ordered_json calibration_figures(const CalibrationReport& report);

/// The same as text.
[[nodiscard]] std::string calibration_json(const CalibrationReport& report);

/// calibration.html: one file that needs nothing else.
[[nodiscard]] std::string calibration_html(const CalibrationReport& report);

}  // namespace marey::app
