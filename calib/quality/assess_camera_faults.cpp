// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_camera_faults.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "calib/quality/calibration_limits.h"
#include "core/base/degrees.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

// Lens errors of 0.1 to 0.3 px look like moves of that size if the board was first in one
// part of the image and later in another.
constexpr double kFairMovePx = 0.6;
constexpr double kPoorMovePx = 1.0;
// In squared sigmas. The largest value in simulated recordings without a fault was 117
// with a board and 352 with a wand (docs/accuracy/camera_faults.md).
constexpr double kMinMoveGain = 400.0;
// Small moves are also detected if frames are not simultaneous, as if a camera skips
// frames.
constexpr double kLooseShare = 0.10;
constexpr double kClearMovePx = 3.0;
// Rolling shutters take 10 to 35 ms; below this value the camera poses hardly change.
constexpr double kFairPicture_s = 0.004;
constexpr double kMinDelaySigmas = 8.0;

double moved_scale(const CalibrationReport& report, std::size_t c) {
  // Inaccurate corners of a camera increase its apparent move.
  return pixel_scale(report.rig.cameras[c]) *
         std::max(1.0, report.cameras[c].inlier_rms_px / 0.5);
}

/// Returns true if the other cameras lose more than a tenth of their corners as outliers
/// (median over cameras).
bool others_are_loose(const CalibrationReport& report, const ApparentMove& move) {
  std::vector<double> shares;
  for (std::size_t c = 0; c < report.cameras.size(); ++c) {
    const CameraId id{static_cast<int>(c)};
    const bool is_suspect = id == move.camera || std::find(move.alternatives.begin(),
                                                           move.alternatives.end(),
                                                           id) != move.alternatives.end();
    const double corners = report.rig.quality[c].corners;
    if (is_suspect || !(corners > 0.0)) continue;
    shares.push_back(report.cameras[c].outlier_corners / corners);
  }
  return !shares.empty() && median(std::move(shares)) > kLooseShare;
}

/// Returns the camera that seems to have been moved, and those that explain the errors as
/// well: "camera cam1 or cam2". Precondition: the report has an apparent move.
std::string moved_cameras(const FindingCollector& list) {
  const ApparentMove& move = *list.report.rig.apparent_move;
  std::string text = list.camera(index(move.camera));
  for (const CameraId other : move.alternatives) {
    text += " or " + list.report.rig.cameras[index(other)].name;
  }
  return text;
}

void assess_move(FindingCollector& list) {
  const auto& move = list.report.rig.apparent_move;
  if (!move) return;
  const std::size_t c = index(move->camera);
  if (!seems_moved(list.report, c)) return;
  const double scale = moved_scale(list.report, c);
  const std::string when =
      move->from_frame
          ? format_text("from frame %d on its views fit a camera", *move->from_frame)
          : std::string("its views of the floor fit a camera");
  const bool is_uncertain =
      move->moved_px < kClearMovePx * scale && others_are_loose(list.report, *move);
  // A change of focus has a small effect in the image and a large one on the camera
  // poses.
  const double poor_shift_m = limits_of(list.report).error_m[1];
  const bool is_harmful =
      move->moved_px > kPoorMovePx * scale || move->rig_shift_m > poor_shift_m;
  std::string effect;
  if (move->rig_shift_m > poor_shift_m) {
    effect =
        format_text("; if that is taken into account, cameras shift by up to %.0f mm",
                    1e3 * move->rig_shift_m);
  }
  list.add(is_uncertain || !is_harmful ? Severity::kFair : Severity::kPoor,
           "moved",
           moved_cameras(list),
           when +
               format_text(
                   " that was moved by %.1f px (%.2f degrees, %.0f mm) %s",
                   move->moved_px,
                   move->turn_rad * kDegreesPerRadian,
                   1e3 * move->shift_m,
                   move->from_frame
                       ? "than before"
                       : format_text("since the %s was waved", list.target()).c_str()) +
               effect,
           is_uncertain
               ? "synchronize the cameras first, as skipped frames look like a small "
                 "move; then fix it firmly, and record the calibration again"
               : "fix it firmly, and record the calibration again without touching "
                 "any camera");
}

/// Reports a lens or a mount that changed slowly or slightly: hardly visible in the
/// image, but enough to shift the calibrated cameras by centimetres.
void assess_unsteady(FindingCollector& list) {
  const auto& move = list.report.rig.apparent_move;
  const auto& rows = list.report.rig.apparent_line_delays;
  if (!move || move->gain < kMinMoveGain || (rows && rows->gain > move->gain)) return;
  const std::size_t c = index(move->camera);
  const auto& limits = limits_of(list.report).error_m;
  if (seems_moved(list.report, c) || move->rig_shift_m < limits[0]) return;
  list.add(
          severity_of(move->rig_shift_m, limits[1]),
          "unsteady",
          moved_cameras(list),
          (move->from_frame ? format_text("its views from frame %d on", *move->from_frame)
                            : std::string("its views of the floor")) +
              format_text(
                  " and those before do not fit one camera: its focus changed or it was "
                  "moved a little (%.1f px); if that is taken into account, cameras "
                  "shift "
                  "by up to %.0f mm",
                  move->moved_px,
                  1e3 * move->rig_shift_m),
          "switch off its autofocus and stabilisation, fix it firmly, and record the "
          "calibration again")
      .measured(1e3 * move->rig_shift_m, 1e3 * limits[0], "mm");
}

void assess_rows(FindingCollector& list) {
  const auto& rows = list.report.rig.apparent_line_delays;
  const auto& move = list.report.rig.apparent_move;
  if (!rows || rows->gain < kMinMoveGain || (move && move->gain > rows->gain)) return;
  double picture_s = 0.0;
  double shift_m = 0.0;
  std::string names;
  for (std::size_t c = 0; c < rows->delay_s.size(); ++c) {
    const Camera& camera = list.report.rig.cameras[c];
    const double own_s = rows->delay_s[c] * camera.intrinsics.height_px;
    shift_m = std::max(shift_m, rows->shift_m[c]);
    if (std::abs(rows->delay_s[c]) < kMinDelaySigmas * rows->sigma_s[c] ||
        std::abs(own_s) < kFairPicture_s) {
      continue;
    }
    picture_s = std::max(picture_s, std::abs(own_s));
    names += (names.empty() ? "" : ", ") + camera.name +
             format_text(" (%.0f ms)", 1e3 * std::abs(own_s));
  }
  if (names.empty()) return;
  const double poor_m = limits_of(list.report).error_m[0];
  list.add(severity_of(shift_m, poor_m),
           "rolling-shutter",
           "cameras " + names,
           format_text(
               "their errors follow the %s's movement row by row: their sensors seem "
               "to take that long from the first row to the last; if that is taken "
               "into account, cameras shift by up to %.0f mm",
               list.target(),
               1e3 * shift_m),
           "set line_delays = true under [calibration] in session.toml, or move the " +
               std::string(list.target()) + " more slowly")
      .measured(1e3 * shift_m, std::nullopt, "mm");
}

void assess_ambiguous(FindingCollector& list) {
  const auto& other = list.report.rig.ambiguous;
  if (!other) return;
  list.add(Severity::kPoor,
           "ambiguous",
           list.camera(index(other->camera)),
           format_text(
               "its place is ambiguous, it may also be %.2f m away: the %d instants "
               "that it shares with other cameras fit both places (%.2f px here, %.2f "
               "px there)",
               other->apart_m,
               other->instants,
               other->rms_px,
               other->other_rms_px),
           format_text(
               "hold the %s near it, tilted by 30 to 45 degrees, in view of another "
               "camera too, a dozen times",
               list.target()))
      .measured(other->apart_m, std::nullopt, "m");
}

}  // namespace

bool seems_moved(const CalibrationReport& report, std::size_t c) {
  const auto& move = report.rig.apparent_move;
  const auto& rows = report.rig.apparent_line_delays;
  // The two faults have similar effects: the one with the larger gain is reported.
  if (move && rows && rows->gain > move->gain) return false;
  return move && index(move->camera) == c && move->gain > kMinMoveGain &&
         move->moved_px > kFairMovePx * moved_scale(report, c);
}

void assess_camera_faults(FindingCollector& list) {
  assess_move(list);
  assess_unsteady(list);
  assess_rows(list);
  assess_ambiguous(list);
}

}  // namespace marey::calib
