// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_residuals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "calib/quality/assess_camera_faults.h"
#include "calib/quality/calibration_limits.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

constexpr double kFairRmsPx = kResidualLimitsPx[0];
constexpr double kPoorRmsPx = kResidualLimitsPx[1];
constexpr double kPoorMedianPx = 2.0;
constexpr double kWorseThanOthers = 2.5;
constexpr double kMinReportedPx = 0.4;
// A few wrong tags in a hundred are usual and have no effect. Above a quarter, the
// inliers are no longer reliable.
constexpr double kPoorOutliers = 0.25;
constexpr double kFairOutliers = 0.05;
constexpr double kFairPatternPx = 0.3;

double share_of_outliers(const CalibrationReport& report, std::size_t c) {
  const double corners = report.rig.quality[c].corners;
  return corners > 0.0 ? report.cameras[c].outlier_corners / corners : 0.0;
}

/// Returns the median of the other cameras' errors; nullopt for a single camera.
std::optional<double> others_px(const CalibrationReport& report, std::size_t c) {
  std::vector<double> others;
  for (std::size_t other = 0; other < report.cameras.size(); ++other) {
    if (other != c) others.push_back(report.cameras[other].inlier_rms_px);
  }
  if (others.empty()) return std::nullopt;
  return median(std::move(others));
}

void assess_level(FindingCollector& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  const bool is_poor = camera.inlier_rms_px > kPoorRmsPx * scale ||
                       camera.median_px > kPoorMedianPx * scale;
  const auto others = others_px(list.report, c);
  const bool stands_out = others && camera.inlier_rms_px > kWorseThanOthers * *others &&
                          camera.inlier_rms_px > kMinReportedPx * scale;
  if (stands_out) {
    list.add(is_poor ? Severity::kPoor : Severity::kFair,
             "worse",
             list.camera(c),
             format_text("its error is %.2f px, that of the others %.2f px",
                         camera.inlier_rms_px,
                         *others),
             "check that its focus is fixed and sharp, that its exposure is short, that "
             "it did not move, and that its video starts with the others'")
        .measured(camera.inlier_rms_px, kWorseThanOthers * *others, "px");
  } else if (is_poor || camera.inlier_rms_px > kFairRmsPx * scale) {
    list.add_mergeable(
            is_poor ? Severity::kPoor : Severity::kFair,
            "residual",
            c,
            format_text("its error is %.2f px (median %.2f; good: under %.1f)",
                        camera.inlier_rms_px,
                        camera.median_px,
                        kFairRmsPx * scale),
            std::string("check the ") + list.target() +
                "'s measures in session.toml, that it is flat and firm, that exposure is "
                "short "
                "and focus fixed, and that all videos start together",
            format_text("%.2f px", camera.inlier_rms_px),
            format_text("their errors are too large (good: under %.1f)",
                        kFairRmsPx * scale))
        .measured(camera.inlier_rms_px, kFairRmsPx * scale, "px");
  }
}

void assess_outliers(FindingCollector& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double share = share_of_outliers(list.report, c);
  // Reported with its size in assess_camera_faults.cpp.
  if (seems_moved(list.report, c)) return;
  // A camera that is out of step also loses whole sections in which the board was fast.
  if ((camera.mismatch_from || camera.mismatch_until) &&
      !has_significant_lag(list.report, c)) {
    list.add(Severity::kPoor,
             "moved",
             list.camera(c),
             camera.mismatch_from
                 ? format_text("from frame %d on its views of the %s do not fit the "
                               "others",
                               *camera.mismatch_from,
                               list.target())
                 : format_text("up to frame %d its views of the %s do not fit the others",
                               *camera.mismatch_until,
                               list.target()),
             list.report.has_clocks
                 ? "fix it firmly: it was touched or refocused, or its video skips "
                   "frames; then record the calibration again"
                 : "if its video starts at another time, set clocks = \"offsets\" under "
                   "[calibration] in session.toml; else it was touched or refocused, or "
                   "skips frames: fix it firmly and record the calibration again");
    return;
  }
  if (share <= kFairOutliers) return;
  list.add_mergeable(
          severity_of(share, kPoorOutliers),
          "outliers",
          c,
          format_text("%.0f %% of its sightings do not fit the rest and were left out "
                      "(good: under "
                      "%.0f %%)",
                      100.0 * share,
                      100.0 * kFairOutliers),
          std::string(
              "look at the frames in calibration.html's list: blur, hands over the ") +
              list.target() +
              ", mirrors, another print with its tags, or cameras that are "
              "out of step",
          format_text("%.0f %%", 100.0 * share),
          format_text(
              "this share of their sightings does not fit the rest and was left out "
              "(good: under %.0f %%)",
              100.0 * kFairOutliers))
      .measured(100.0 * share, 100.0 * kFairOutliers, "%");
}

/// Reports frames in which several cameras disagree with the board's pose.
void assess_frames(FindingCollector& list) {
  std::map<int, std::set<int>> cameras;
  std::map<int, int> left_out;
  int all = 0;
  for (const OutlierFrame& frame : list.report.rig.outlier_frames) {
    all += frame.sightings;
    left_out[frame.frame] += frame.sightings;
    cameras[frame.frame].insert(static_cast<int>(frame.camera));
  }
  constexpr int kMinReported = 10;
  for (const auto& [frame, count] : left_out) {
    if (count < kMinReported || 2 * count < all || cameras.at(frame).size() < 2) continue;
    list.add(
        Severity::kNote,
        "outlier-frame",
        frame != kFloorInstant ? format_text("frame %d", frame)
        : list.report.extent   ? "floor"
                               : "scenery",
        format_text("it contains %d of all %d sightings that were left out", count, all),
        format_text("they do no harm; if it recurs, turn the %s more slowly",
                    list.target()));
  }
}

void assess_lag(FindingCollector& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  if (!has_significant_lag(list.report, c)) return;
  const double ms =
      list.report.rate_hz > 0.0 ? 1e3 * camera.lag->frames / list.report.rate_hz : 0.0;
  const char* way = camera.lag->frames > 0.0 ? "later" : "earlier";
  list.add_mergeable(
          Severity::kFair,
          "clock",
          c,
          format_text("its errors follow the %s's movement (%.2f px): it is %.0f ms or "
                      "more %s than "
                      "the others",
                      list.target(),
                      camera.lag->explained_px,
                      std::abs(ms),
                      way),
          std::string(
              "start all cameras together, let marey solve for their clocks, or move "
              "the ") +
              list.target() + " more slowly",
          format_text("%.0f ms %s", std::abs(ms), way),
          std::string("their errors follow the ") + list.target() +
              "'s movement: they are out of step by this time or more")
      .measured(std::abs(ms), std::nullopt, "ms");
}

void assess_pattern(FindingCollector& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  if (camera.pattern_px < kFairPatternPx * scale ||
      camera.pattern_px < 0.5 * camera.inlier_rms_px) {
    return;
  }
  list.add(Severity::kFair,
           "lens",
           list.camera(c),
           format_text(
               "%.2f px of its errors are the same at each place in the picture for "
               "all places of the %s: the lens model does not describe this "
               "distortion",
               camera.pattern_px,
               list.target()),
           "choose another lens model in session.toml, and switch off the camera's own "
           "correction or stabilisation")
      .measured(camera.pattern_px, kFairPatternPx * scale, "px");
}

void assess_floor(FindingCollector& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  if (!camera.floor_median_px || *camera.floor_median_px < 1.5 * scale ||
      *camera.floor_median_px < 3.0 * camera.inlier_rms_px) {
    return;
  }
  if (!list.report.extent) {
    list.add(severity_of(*camera.floor_median_px, 5.0 * scale),
             "scenery",
             list.camera(c),
             format_text(
                 "static tags are %.1f px from where they should be, the wand's %.2f "
                 "px",
                 *camera.floor_median_px,
                 camera.inlier_rms_px),
             "the camera or those tags were touched while the wand was carried about: "
             "record the calibration again without touching anything")
        .measured(*camera.floor_median_px, std::nullopt, "px");
    return;
  }
  list.add(severity_of(*camera.floor_median_px, 5.0 * scale),
           "floor",
           list.camera(c),
           format_text(
               "the board on the floor is %.1f px from where it should be, the moving "
               "one %.2f px",
               *camera.floor_median_px,
               camera.inlier_rms_px),
           "the camera was touched between the two trials, or the board did not lie "
           "still: record both again without touching anything")
      .measured(*camera.floor_median_px, std::nullopt, "px");
}

/// Reports an implausible floor. Cameras and a waved board must be above it.
void assess_ground(FindingCollector& list) {
  constexpr double kBelow_m = 0.3;
  if (!list.report.board_on_floor) return;
  std::vector<double> heights_m;
  std::set<std::size_t> floor_cameras;  // Cameras that see the board on the floor.
  for (const TargetView& view : list.report.rig.views) {
    if (!view.stays) heights_m.push_back(view.world_from_target.translation.y);
    if (view.frame == kFloorInstant) floor_cameras.insert(index(view.camera));
  }
  if (floor_cameras.size() == 1) {
    list.add(Severity::kFair,
             "floor",
             list.camera(*floor_cameras.begin()),
             "no other camera sees the board on the floor: an exchanged video or a floor "
             "that is not level would not be detected",
             "record the floor trial with the board where two cameras see it");
  }
  const char* next =
      "check that each floor video is from its own camera, and that the board lay on the "
      "floor";
  if (!heights_m.empty()) {
    const double lowest_m = quantile(std::move(heights_m), 0.05);
    if (lowest_m < -kBelow_m) {
      list.add(
          Severity::kPoor,
          "floor",
          "all cameras",
          format_text("the board was waved %.1f m below the floor of the floor trial",
                      -lowest_m),
          next);
    }
  }
  for (std::size_t c = 0; c < list.report.rig.cameras.size(); ++c) {
    const double height_m = centre_in_world(list.report.rig.cameras[c]).y;
    if (height_m > -kBelow_m) continue;
    list.add(Severity::kPoor,
             "floor",
             list.camera(c),
             format_text("it would stand %.1f m below the floor of the floor trial",
                         -height_m),
             next);
  }
}

void assess_warp(FindingCollector& list) {
  if (!list.report.rig.warp_m) return;
  double max_m = 0.0;
  for (const double rise_m : *list.report.rig.warp_m) {
    max_m = std::max(max_m, std::abs(rise_m));
  }
  constexpr double kMinReported_m = 1e-3;
  if (max_m < kMinReported_m) return;
  list.add(Severity::kNote,
           "warp",
           "board",
           format_text("its plate is bent by %.1f mm, which was taken into account",
                       1e3 * max_m),
           "glue the print to glass or a stiff plate");
}

}  // namespace

bool has_significant_lag(const CalibrationReport& report, std::size_t c) {
  const std::optional<CameraLag>& lag = report.cameras[c].lag;
  // Errors of neighbouring views are correlated: four sigmas of independent views are not
  // sufficient.
  constexpr double kMinLagSigmas = 6.0;
  return lag && std::abs(lag->frames) > kMinLagSigmas * lag->sigma_frames &&
         lag->explained_px > kFairPatternPx * pixel_scale(report.rig.cameras[c]);
}

void assess_residuals(FindingCollector& list) {
  for (std::size_t c = 0; c < list.report.cameras.size(); ++c) {
    assess_level(list, c);
    assess_outliers(list, c);
    assess_lag(list, c);
    assess_pattern(list, c);
    assess_floor(list, c);
  }
  assess_frames(list);
  assess_ground(list);
  assess_warp(list);
}

}  // namespace marey::calib
