// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pages/calibration_html.h"

#include <algorithm>
#include <map>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "app/pages/calibration_json.h"
#include "app/pages/fill_page.h"
#include "app/pages/report_json.h"
#include "app/pages/report_page.h"
#include "calib/quality/calibration_report.h"
#include "core/base/degrees.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;
using calib::SeenCorner;
using calib::TargetView;

// Largest number of arrows that stay readable in a picture; pages stay below a megabyte.
constexpr std::size_t kMaxArrows = 600;
constexpr std::size_t kMaxOutliers = 200;
constexpr std::size_t kMaxPlaces = 60;

/// Returns at most `maximum` items of `all`, evenly spaced.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t maximum) {
  std::vector<T> out;
  const std::size_t count = std::min(all.size(), maximum);
  for (std::size_t i = 0; i < count; ++i) out.push_back(all[i * all.size() / count]);
  return out;
}

Json arrow(const SeenCorner& corner) {
  return {rounded(corner.seen_px.x, 1),
          rounded(corner.seen_px.y, 1),
          rounded(corner.error_px.x, 3),
          rounded(corner.error_px.y, 3)};
}

Json page_camera(const calib::CalibrationReport& report, std::size_t c) {
  std::vector<SeenCorner> inliers;
  std::vector<SeenCorner> outliers;
  for (const TargetView& view : report.rig.views) {
    if (index(view.camera) != c) continue;
    for (const SeenCorner& corner : view.corners) {
      (corner.is_outlier ? outliers : inliers).push_back(corner);
    }
  }
  std::stable_sort(outliers.begin(), outliers.end(), [](const auto& a, const auto& b) {
    return glm::length(a.error_px) > glm::length(b.error_px);
  });
  outliers.resize(std::min(outliers.size(), kMaxOutliers));
  Json arrows = Json::array();
  for (const SeenCorner& corner : thinned(inliers, kMaxArrows)) {
    arrows.push_back(arrow(corner));
  }
  Json strays = Json::array();
  for (const SeenCorner& corner : outliers) strays.push_back(arrow(corner));
  Json tilts = Json::array();
  for (const calib::ViewTilt& tilt : thinned(report.cameras[c].tilts, kMaxArrows)) {
    tilts.push_back({rounded(kDegreesPerRadian * tilt.tilt_rad, 1),
                     rounded(kDegreesPerRadian * tilt.azimuth_rad, 0),
                     rounded(tilt.distance_m, 2)});
  }
  return {{"arrows", arrows}, {"strays", strays}, {"tilts", tilts}};
}

/// Returns the places of the board (its four corners) or of the wand (its origin).
Json outline(const calib::CalibrationReport& report,
             const RigidTransform& world_from_target) {
  std::vector<glm::dvec3> corners{glm::dvec3(0.0)};
  if (report.extent) {
    const glm::dvec3& low = report.extent->min_in_board;
    const glm::dvec3& high = report.extent->max_in_board;
    corners = {low, {high.x, low.y, 0.0}, high, {low.x, high.y, 0.0}};
  }
  Json out = Json::array();
  for (const glm::dvec3& corner : corners) {
    const glm::dvec3 p = world_from_target * corner;
    out.push_back({rounded(p.x, 3), rounded(p.y, 3), rounded(p.z, 3)});
  }
  return out;
}

Json page_places(const calib::CalibrationReport& report, bool on_floor) {
  std::map<std::pair<int, int>, RigidTransform> places;
  for (const TargetView& view : report.rig.views) {
    if (!report.extent && view.stays) continue;
    if ((view.frame == calib::kFloorInstant) != on_floor) continue;
    places.insert({{view.target, view.frame}, view.world_from_target});
  }
  std::vector<RigidTransform> all;
  for (const auto& [key, place] : places) all.push_back(place);
  Json out = Json::array();
  for (const RigidTransform& place : thinned(all, kMaxPlaces)) {
    out.push_back(outline(report, place));
  }
  return out;
}

}  // namespace

std::string calibration_html(const calib::CalibrationReport& report) {
  Json cameras = Json::array();
  for (std::size_t c = 0; c < report.rig.cameras.size(); ++c) {
    cameras.push_back(page_camera(report, c));
  }
  const Json data{{"figures", calibration_json(report)},
                  {"cameras", cameras},
                  {"places", page_places(report, false)},
                  {"floor_places", page_places(report, true)}};
  return fill_page(
      calibration_page(),
      {{"style", std::string(report_style()) + std::string(calibration_style())},
       {"data", json_in_html(data)},
       {"script", std::string(calibration_script())}});
}

}  // namespace marey::app
