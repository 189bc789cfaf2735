// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_faults.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/calibration_limits.h"
#include "app/judge_residuals.h"

namespace marey::app {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Lens errors of 0.1 to 0.3 px look like moves of that size where the board was in one
// part of the picture first and in another later.
constexpr double kFairMovePx = 0.6;
constexpr double kPoorMovePx = 1.0;
// In squared sigmas. Neighbouring views share their errors: chance alone reaches some
// hundred.
constexpr double kSureGain = 400.0;
// Rolling shutters take 10 to 35 ms; below these the places of cameras hardly follow.
constexpr double kFairPicture_s = 0.004;
constexpr double kSurely = 8.0;

double moved_scale(const CalibrationReport& report, std::size_t c) {
  // Coarse corners of a camera look moved by more.
  return pixel_scale(report.rig.cameras[c]) *
         std::max(1.0, report.cameras[c].inlier_rms_px / 0.5);
}

void judge_move(FindingList& list) {
  const auto& move = list.report.rig.apparent_move;
  if (!move) return;
  const std::size_t c = index(move->camera);
  if (!seems_moved(list.report, c)) return;
  const double scale = moved_scale(list.report, c);
  std::string others;
  for (const CameraId other : move->instead) {
    others += " or " + list.report.rig.cameras[index(other)].name;
  }
  const std::string when =
      move->from_frame
          ? worded("from frame %d on what it saw fits a camera", *move->from_frame)
          : std::string("what it saw of the floor fits a camera");
  list.add(graver(move->moved_px, kPoorMovePx * scale),
           "moved",
           list.camera(c) + others,
           when + worded(" that was moved by %.1f px (%.2f degrees, %.0f mm) %s",
                         move->moved_px,
                         move->turn_rad * kDegrees,
                         1e3 * move->shift_m,
                         move->from_frame
                             ? "than before"
                             : worded("since the %s was waved", list.target()).c_str()),
           std::string("fix it firmly, and record the calibration again without touching "
                       "any camera"));
}

void judge_rows(FindingList& list) {
  const auto& rows = list.report.rig.apparent_line_delays;
  const auto& move = list.report.rig.apparent_move;
  if (!rows || rows->gain < kSureGain || (move && move->gain > rows->gain)) return;
  double picture_s = 0.0;
  double shift_m = 0.0;
  std::string names;
  for (std::size_t c = 0; c < rows->delay_s.size(); ++c) {
    const Camera& camera = list.report.rig.cameras[c];
    const double own_s = rows->delay_s[c] * camera.intrinsics.height_px;
    shift_m = std::max(shift_m, rows->shift_m[c]);
    if (std::abs(rows->delay_s[c]) < kSurely * rows->sigma_s[c] ||
        std::abs(own_s) < kFairPicture_s) {
      continue;
    }
    picture_s = std::max(picture_s, std::abs(own_s));
    names += (names.empty() ? "" : ", ") + camera.name +
             worded(" (%.0f ms)", 1e3 * std::abs(own_s));
  }
  if (names.empty()) return;
  const double poor_m = limits_of(list.report).error_m[0];
  list.add(graver(shift_m, poor_m),
           "rolling-shutter",
           "cameras " + names,
           worded("their errors follow the %s's movement row by row, as of sensors that "
                  "take that long from the first row to the last: cameras stand up to "
                  "%.0f mm elsewhere if that is taken into account",
                  list.target(),
                  1e3 * shift_m),
           "set line_delays = true under [calibration] in session.toml, or move the " +
               std::string(list.target()) + " more slowly");
}

void judge_ambiguous(FindingList& list) {
  const auto& other = list.report.rig.ambiguous;
  if (!other) return;
  list.add(Severity::kPoor,
           "ambiguous",
           list.camera(index(other->camera)),
           worded("it may as well stand %.2f m elsewhere: the %d instants that it shares "
                  "with other cameras read two ways (%.2f px as it stands, %.2f px "
                  "there)",
                  other->apart_m,
                  other->instants,
                  other->rms_px,
                  other->other_rms_px),
           worded("hold the %s near it and tilted by 30 to 45 degrees, where it and "
                  "another camera see it, a dozen times",
                  list.target()));
}

}  // namespace

bool seems_moved(const CalibrationReport& report, std::size_t c) {
  const auto& move = report.rig.apparent_move;
  const auto& rows = report.rig.apparent_line_delays;
  // One fault looks a little like the other: the one that explains more is named.
  if (move && rows && rows->gain > move->gain) return false;
  return move && index(move->camera) == c && move->gain > kSureGain &&
         move->moved_px > kFairMovePx * moved_scale(report, c);
}

void judge_faults(FindingList& list) {
  judge_move(list);
  judge_rows(list);
  judge_ambiguous(list);
}

}  // namespace marey::app
