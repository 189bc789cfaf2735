// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/measure_calibration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "calib/quality/measure_lag.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// Returns the cell of an image, row by row, as in CameraQuality::coverage; positions
/// outside count for the nearest cell.
int cell_of(const Intrinsics& k, const glm::vec2& pixel_px, int columns, int rows) {
  const int column = static_cast<int>(columns * double{pixel_px.x} / k.width_px);
  const int row = static_cast<int>(rows * double{pixel_px.y} / k.height_px);
  return columns * std::clamp(row, 0, rows - 1) + std::clamp(column, 0, columns - 1);
}

/// Errors of one area of the image.
struct Area {
  glm::dvec2 sum_px{0.0};
  double squares = 0.0;
  std::set<int> frames;
};

/// Returns the part of the areas' mean errors that chance does not explain. Errors of one
/// frame are correlated (they share the board's pose), so the precision of a mean depends
/// on the number of frames, not of corners.
double pattern_px(const std::map<int, Area>& areas, const std::map<int, int>& corners) {
  constexpr std::size_t kMinFrames = 6;
  double squares = 0.0;
  double weight = 0.0;
  for (const auto& [cell, area] : areas) {
    const double n = corners.at(cell);
    if (area.frames.size() < kMinFrames) continue;
    const glm::dvec2 mean = area.sum_px / n;
    const double square = glm::dot(mean, mean);
    const double spread = std::max(0.0, area.squares / n - square);
    squares += n * (square - spread / static_cast<double>(area.frames.size()));
    weight += n;
  }
  return weight > 0.0 && squares > 0.0 ? std::sqrt(squares / weight) : 0.0;
}

std::optional<ViewTilt> tilt_of(const CalibrationReport& report,
                                const TargetView& view,
                                const Camera& camera) {
  if (!report.extent) return std::nullopt;
  const RigidTransform camera_from_board =
      camera.camera_from_world * view.world_from_target;
  glm::dvec3 normal = camera_from_board.rotation * glm::dvec3(0.0, 0.0, 1.0);
  // A two-sided board has the same tilt from the back.
  if (normal.z > 0.0) normal = -normal;
  const glm::dvec3 middle =
      camera_from_board *
      (0.5 * (report.extent->min_in_board + report.extent->max_in_board));
  return ViewTilt{std::acos(std::clamp(-normal.z, -1.0, 1.0)),
                  std::atan2(normal.y, normal.x),
                  glm::length(middle)};
}

/// Finds the frame at which a camera stops (or starts) to fit: most of its sightings on
/// one side of it are outliers, and hardly any on the other.
void find_mismatch(const std::vector<const TargetView*>& views, CameraMeasures& out) {
  constexpr std::size_t kMin = 5;
  constexpr double kMax = 0.7;
  constexpr double kMaxInlierSide = 0.1;
  if (views.size() < 2 * kMin) return;
  std::vector<double> outlier_sums;  // Running sum of the views' shares of outliers.
  outlier_sums.push_back(0.0);
  for (const TargetView* view : views) {
    const auto count = std::count_if(view->corners.begin(),
                                     view->corners.end(),
                                     [](const SeenCorner& c) { return c.is_outlier; });
    outlier_sums.push_back(outlier_sums.back() +
                           static_cast<double>(count) /
                               static_cast<double>(view->corners.size()));
  }
  double clearest = 0.0;
  for (std::size_t i = kMin; i + kMin <= views.size(); ++i) {
    const double before = outlier_sums[i] / static_cast<double>(i);
    const double after =
        (outlier_sums.back() - outlier_sums[i]) / static_cast<double>(views.size() - i);
    if (std::max(before, after) < kMax || std::min(before, after) > kMaxInlierSide)
      continue;
    if (std::abs(after - before) <= clearest) continue;
    clearest = std::abs(after - before);
    out.mismatch_from.reset();
    out.mismatch_until.reset();
    (after > before ? out.mismatch_from : out.mismatch_until) =
        views[after > before ? i : i - 1]->frame;
  }
}

CameraMeasures measure(const CalibrationReport& report, std::size_t c) {
  const Camera& camera = report.rig.cameras[c];
  CameraMeasures out;
  std::vector<double> errors_px;
  std::vector<double> staying_px;  // On the floor board or static tags.
  double squares = 0.0;
  std::set<int> coarse;
  std::map<int, Area> areas;
  std::map<int, int> area_corners;
  std::map<int, std::vector<const TargetView*>> moving;  // By target.
  for (const TargetView& view : report.rig.views) {
    if (index(view.camera) != c || view.corners.empty()) continue;
    if (!view.stays) moving[view.target].push_back(&view);
    if (const auto tilt = tilt_of(report, view, camera); tilt && !view.stays) {
      out.tilts.push_back(*tilt);
    }
    for (const SeenCorner& corner : view.corners) {
      const Intrinsics& k = camera.intrinsics;
      const double error_px = glm::length(corner.error_px);
      if (view.frame == kFloorInstant) staying_px.push_back(error_px);
      // As in the camera's quality, which does not include static tags.
      if (view.stays && !report.extent) continue;
      errors_px.push_back(error_px);
      const int area = cell_of(k, corner.seen_px, 8, 6);
      coarse.insert(area);
      const int cell = cell_of(k, corner.seen_px, kCoverageColumns, kCoverageRows);
      ++out.cells[static_cast<std::size_t>(cell)];
      if (corner.is_outlier) {
        ++out.outlier_corners;
        continue;
      }
      squares += error_px * error_px;
      areas[area].sum_px += glm::dvec2(corner.error_px);
      areas[area].squares += error_px * error_px;
      areas[area].frames.insert(view.frame);
      ++area_corners[area];
    }
  }
  for (const int cell : coarse) {
    out.half_coverage[cell % 8 < 4 ? 0 : 1] += 1.0 / 24.0;
    out.half_coverage[cell / 8 < 3 ? 2 : 3] += 1.0 / 24.0;
  }
  const auto inliers = static_cast<double>(errors_px.size()) - out.outlier_corners;
  out.inlier_rms_px = inliers > 0.0 ? std::sqrt(squares / inliers) : 0.0;
  if (!errors_px.empty()) out.median_px = median(std::move(errors_px));
  if (!staying_px.empty()) out.floor_median_px = median(std::move(staying_px));
  out.pattern_px = pattern_px(areas, area_corners);
  for (const auto& [target, views] : moving) {
    const std::vector<PassingView> passing = passing_views(report, camera, views);
    if (!report.has_clocks && !out.lag) out.lag = lag_of(passing);
    if (!out.slip) out.slip = slip_of(passing);
    find_mismatch(views, out);
  }
  std::vector<double> tilts_rad;
  for (const ViewTilt& tilt : out.tilts) tilts_rad.push_back(tilt.tilt_rad);
  if (!tilts_rad.empty()) out.p90_tilt_rad = quantile(std::move(tilts_rad), 0.9);
  const std::size_t cameras = report.rig.cameras.size();
  if (report.rig.shared_views.size() == cameras * cameras) {
    out.instants = report.rig.shared_views[c * cameras + c];
  }
  return out;
}

}  // namespace

std::vector<CameraMeasures> measure_cameras(const CalibrationReport& report) {
  std::vector<CameraMeasures> out;
  for (std::size_t c = 0; c < report.rig.cameras.size(); ++c) {
    out.push_back(measure(report, c));
  }
  return out;
}

}  // namespace marey::calib
