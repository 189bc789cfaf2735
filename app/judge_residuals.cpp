// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_residuals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "app/calibration_limits.h"
#include "app/judge_faults.h"
#include "core/quantile.h"

namespace marey::app {
namespace {

constexpr double kFairRmsPx = kResidualLimitsPx[0];
constexpr double kPoorRmsPx = kResidualLimitsPx[1];
constexpr double kPoorMedianPx = 2.0;
constexpr double kWorseThanOthers = 2.5;
constexpr double kWorthSayingPx = 0.4;
// A few wrong tags in a hundred are usual and do no harm; when a quarter does not fit, it
// is no longer clear who is right.
constexpr double kPoorOutliers = 0.25;
constexpr double kFairOutliers = 0.05;
constexpr double kFairPatternPx = 0.3;

double share_of_outliers(const CalibrationReport& report, std::size_t c) {
  const double corners = report.rig.quality[c].corners;
  return corners > 0.0 ? report.cameras[c].outlier_corners / corners : 0.0;
}

/// Median of what the other cameras have; nullopt of a single one.
std::optional<double> others_px(const CalibrationReport& report, std::size_t c) {
  std::vector<double> others;
  for (std::size_t other = 0; other < report.cameras.size(); ++other) {
    if (other != c) others.push_back(report.cameras[other].inlier_rms_px);
  }
  if (others.empty()) return std::nullopt;
  return median(std::move(others));
}

void judge_level(FindingList& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  const bool is_poor = camera.inlier_rms_px > kPoorRmsPx * scale ||
                       camera.median_px > kPoorMedianPx * scale;
  const auto others = others_px(list.report, c);
  const bool stands_out = others && camera.inlier_rms_px > kWorseThanOthers * *others &&
                          camera.inlier_rms_px > kWorthSayingPx * scale;
  if (stands_out) {
    list.add(is_poor ? Severity::kPoor : Severity::kFair,
             "worse",
             list.camera(c),
             worded("it is %.2f px away from what it saw, the others %.2f px",
                    camera.inlier_rms_px,
                    *others),
             "check that its focus is fixed and sharp, that its exposure is short, that "
             "it did not move, and that its video starts with the others'");
  } else if (is_poor || camera.inlier_rms_px > kFairRmsPx * scale) {
    list.add_shared(
        is_poor ? Severity::kPoor : Severity::kFair,
        "residual",
        c,
        worded("it is %.2f px away from what it saw (median %.2f; good: under %.1f)",
               camera.inlier_rms_px,
               camera.median_px,
               kFairRmsPx * scale),
        std::string("check the ") + list.target() +
            "'s measures in session.toml, that it is flat and firm, that exposure is "
            "short "
            "and focus fixed, and that all videos start together",
        worded("%.2f px", camera.inlier_rms_px),
        worded("they are that far from what they saw (good: under %.1f)",
               kFairRmsPx * scale));
  }
}

void judge_outliers(FindingList& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double share = share_of_outliers(list.report, c);
  // Told with its amount (judge_faults.h).
  if (seems_moved(list.report, c)) return;
  // A camera that is out of step loses whole stretches too: where the board was fast.
  if ((camera.astray_from || camera.astray_until) && !is_late(list.report, c)) {
    list.add(Severity::kPoor,
             "moved",
             list.camera(c),
             camera.astray_from
                 ? worded("from frame %d on it does not see the %s where it should",
                          *camera.astray_from,
                          list.target())
                 : worded("up to frame %d it does not see the %s where it should",
                          *camera.astray_until,
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
  list.add_shared(
      graver(share, kPoorOutliers),
      "outliers",
      c,
      worded("%.0f %% of what it saw does not go with the rest and was left out (good: "
             "under %.0f %%)",
             100.0 * share,
             100.0 * kFairOutliers),
      std::string(
          "look at the frames in calibration.html's list: blur, hands over the ") +
          list.target() +
          ", mirrors, another print with its tags, or cameras that are "
          "out of step",
      worded("%.0f %%", 100.0 * share),
      worded("that much of what they saw does not go with the rest and was left out "
             "(good: under %.0f %%)",
             100.0 * kFairOutliers));
}

/// Frames in which several cameras disagree with the board's place.
void judge_frames(FindingList& list) {
  std::map<int, std::set<int>> cameras;
  std::map<int, int> left_out;
  int all = 0;
  for (const calib::OutlierFrame& frame : list.report.rig.outlier_frames) {
    all += frame.sightings;
    left_out[frame.frame] += frame.sightings;
    cameras[frame.frame].insert(static_cast<int>(frame.camera));
  }
  constexpr int kWorthSaying = 10;
  for (const auto& [frame, count] : left_out) {
    if (count < kWorthSaying || 2 * count < all || cameras.at(frame).size() < 2) continue;
    list.add(
        Severity::kNote,
        "outlier-frame",
        frame != calib::kFloorInstant ? worded("frame %d", frame)
        : list.report.extent          ? "floor"
                                      : "scenery",
        worded("%d of all %d sightings that were left out are in it", count, all),
        worded("they do no harm; if it recurs, turn the %s more slowly", list.target()));
  }
}

void judge_lag(FindingList& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  if (!is_late(list.report, c)) return;
  const double ms =
      list.report.rate_hz > 0.0 ? 1e3 * camera.lag->frames / list.report.rate_hz : 0.0;
  const char* way = camera.lag->frames > 0.0 ? "later" : "earlier";
  list.add_shared(
      Severity::kFair,
      "clock",
      c,
      worded(
          "its errors follow the %s's movement (%.2f px): it is %.0f ms or more %s than "
          "the others",
          list.target(),
          camera.lag->explained_px,
          std::abs(ms),
          way),
      std::string("start all cameras together, let their clocks be found, or move the ") +
          list.target() + " more slowly",
      worded("%.0f ms %s", std::abs(ms), way),
      std::string("their errors follow the ") + list.target() +
          "'s movement: they are out of step by that or more");
}

void judge_pattern(FindingList& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  if (camera.pattern_px < kFairPatternPx * scale ||
      camera.pattern_px < 0.5 * camera.inlier_rms_px) {
    return;
  }
  list.add(Severity::kFair,
           "lens",
           list.camera(c),
           worded("%.2f px of its errors point the same way wherever the %s was: the "
                  "lens bends the picture in a way that its model does not have",
                  camera.pattern_px,
                  list.target()),
           "choose another lens model in session.toml, and switch off the camera's own "
           "correction or stabilisation");
}

void judge_floor(FindingList& list, std::size_t c) {
  const CameraMeasures& camera = list.report.cameras[c];
  const double scale = pixel_scale(list.report.rig.cameras[c]);
  if (!camera.floor_median_px || *camera.floor_median_px < 1.5 * scale ||
      *camera.floor_median_px < 3.0 * camera.inlier_rms_px) {
    return;
  }
  if (!list.report.extent) {
    list.add(graver(*camera.floor_median_px, 5.0 * scale),
             "scenery",
             list.camera(c),
             worded("tags that stay are %.1f px from where they should be, the wand's "
                    "%.2f px",
                    *camera.floor_median_px,
                    camera.inlier_rms_px),
             "the camera or those tags were touched while the wand was carried about: "
             "record the calibration again without touching anything");
    return;
  }
  list.add(graver(*camera.floor_median_px, 5.0 * scale),
           "floor",
           list.camera(c),
           worded("the board on the floor is %.1f px from where it should be, the moving "
                  "one %.2f px",
                  *camera.floor_median_px,
                  camera.inlier_rms_px),
           "the camera was touched between the two trials, or the board did not lie "
           "still: record both again without touching anything");
}

/// Reports an implausible floor. Cameras are above it, and so is a board that is waved.
void judge_ground(FindingList& list) {
  constexpr double kBelow_m = 0.3;
  if (!list.report.board_on_floor) return;
  std::vector<double> heights_m;
  std::set<std::size_t> witnesses;  // Cameras that see the board on the floor.
  for (const calib::TargetView& view : list.report.rig.views) {
    if (!view.stays) heights_m.push_back(view.world_from_target.translation.y);
    if (view.frame == calib::kFloorInstant) witnesses.insert(index(view.camera));
  }
  if (witnesses.size() == 1) {
    list.add(Severity::kFair,
             "floor",
             list.camera(*witnesses.begin()),
             "no other camera sees the board on the floor: an exchanged video or a floor "
             "that is not level would go unnoticed",
             "record the floor trial with the board where two cameras see it");
  }
  const char* next =
      "check that each floor video is from its own camera, and that the board lay on the "
      "floor";
  if (!heights_m.empty()) {
    const double lowest_m = quantile(std::move(heights_m), 0.05);
    if (lowest_m < -kBelow_m) {
      list.add(Severity::kPoor,
               "floor",
               "all cameras",
               worded("the board was waved %.1f m below the floor of the floor trial",
                      -lowest_m),
               next);
    }
  }
  for (std::size_t c = 0; c < list.report.rig.cameras.size(); ++c) {
    const double height_m = centre_in_world(list.report.rig.cameras[c]).y;
    if (height_m > -kBelow_m) continue;
    list.add(
        Severity::kPoor,
        "floor",
        list.camera(c),
        worded("it would stand %.1f m below the floor of the floor trial", -height_m),
        next);
  }
}

void judge_warp(FindingList& list) {
  if (!list.report.rig.warp_m) return;
  double most_m = 0.0;
  for (const double rise_m : *list.report.rig.warp_m) {
    most_m = std::max(most_m, std::abs(rise_m));
  }
  constexpr double kWorthSaying_m = 1e-3;
  if (most_m < kWorthSaying_m) return;
  list.add(
      Severity::kNote,
      "warp",
      "board",
      worded("its plate is bent by %.1f mm, which was taken into account", 1e3 * most_m),
      "glue the print to glass or a stiff plate");
}

}  // namespace

bool is_late(const CalibrationReport& report, std::size_t c) {
  const std::optional<CameraLag>& lag = report.cameras[c].lag;
  // Views next to each other share their errors: four sigmas of independent ones are few.
  constexpr double kSureLag = 6.0;
  return lag && std::abs(lag->frames) > kSureLag * lag->sigma_frames &&
         lag->explained_px > kFairPatternPx * pixel_scale(report.rig.cameras[c]);
}

void judge_residuals(FindingList& list) {
  for (std::size_t c = 0; c < list.report.cameras.size(); ++c) {
    judge_level(list, c);
    judge_outliers(list, c);
    judge_lag(list, c);
    judge_pattern(list, c);
    judge_floor(list, c);
  }
  judge_frames(list);
  judge_ground(list);
  judge_warp(list);
}

}  // namespace marey::app
