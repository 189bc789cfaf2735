// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/map_errors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "calib/plan/body_heights.h"
#include "calib/plan/plan_rig.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// Returns the positions of the moving target's middle, once per instant.
std::vector<glm::dvec3> error_places(const CalibrationReport& report) {
  std::map<std::pair<int, int>, glm::dvec3> places;
  const glm::dvec3 middle =
      report.extent ? 0.5 * (report.extent->min_in_board + report.extent->max_in_board)
                    : glm::dvec3(0.0);
  for (const TargetView& view : report.rig.views) {
    // A static board counts only if there is no other: images taken one by one.
    if (view.stays) continue;
    places.insert({{view.target, view.frame}, view.world_from_target * middle});
  }
  std::vector<glm::dvec3> out;
  for (const auto& [key, place] : places) out.push_back(place);
  return out;
}

double along(const std::vector<glm::dvec3>& places, int axis, double share) {
  std::vector<double> values;
  for (const glm::dvec3& place : places) values.push_back(place[axis]);
  return quantile(std::move(values), share);
}

/// Returns a step of one significant digit, about a fortieth of `extent_m`.
double step_of(double extent_m) {
  const double raw = extent_m / 45.0;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10.0 * power;
}

double outward(double value, double step, int way) {
  return step * (way > 0 ? std::ceil(value / step) : std::floor(value / step));
}

void set_grid(const CalibrationReport& report,
              const std::vector<glm::dvec3>& places,
              CalibrationMap& map) {
  const ErrorMapGrid before = grid_before(report.rig.cameras);
  glm::dvec3 min_place = before.min_in_world;
  glm::dvec3 max_place = before.max_in_world;
  if (!places.empty()) {
    const glm::dvec3 low{along(places, 0, 0.02), 0.0, along(places, 2, 0.02)};
    const glm::dvec3 high{along(places, 0, 0.98), 0.0, along(places, 2, 0.98)};
    const double extent_m = std::max(high.x - low.x, high.z - low.z);
    const glm::dvec3 rim{std::max(0.15 * extent_m, report.has_floor ? 0.3 : 0.05)};
    min_place = report.has_floor ? glm::min(min_place, low - rim) : low - rim;
    max_place = report.has_floor ? glm::max(max_place, high + rim) : high + rim;
  }
  const double step_m =
      step_of(std::max(max_place.x - min_place.x, max_place.z - min_place.z));
  for (const int axis : {0, 2}) {
    map.grid.min_in_world[axis] = outward(min_place[axis], step_m, -1);
    map.grid.max_in_world[axis] = outward(max_place[axis], step_m, +1);
  }
  map.grid.step_m = step_m;
}

void set_heights(const CalibrationReport& report,
                 const std::vector<glm::dvec3>& places,
                 CalibrationMap& map) {
  map.grid.heights_m.clear();
  if (report.has_floor || places.empty()) {
    for (const BodyHeight& height : kBodyHeights) {
      map.grid.heights_m.push_back(height.over_stature * report.stature_m);
      map.height_names.emplace_back(height.name);
    }
    return;
  }
  const std::array<std::pair<const char*, double>, 3> shares{
      {{"low", 0.1}, {"middle", 0.5}, {"high", 0.9}}};
  for (const auto& [name, share] : shares) {
    map.grid.heights_m.push_back(along(places, 1, share));
    map.height_names.emplace_back(name);
  }
}

/// Returns the largest error over the heights there; nullopt if fewer than two cameras
/// see one of them.
std::optional<double> error_at(const CalibrationReport& report,
                               const ErrorMapGrid& grid,
                               const glm::dvec3& place) {
  const auto* covariance =
      report.rig.covariance.values.empty() ? nullptr : &report.rig.covariance;
  std::optional<double> worst_m;
  for (const double height_m : grid.heights_m) {
    const glm::dvec3 p{place.x, height_m, place.z};
    const auto seen_by = cameras_that_see(report.rig.cameras, p);
    const auto found = point_covariance(
        report.rig.cameras, seen_by, covariance, p, report.corner_sigma_px);
    if (!found) continue;
    worst_m = std::max(worst_m.value_or(0.0), expected_error_m(*found));
  }
  return worst_m;
}

}  // namespace

CalibrationMap map_errors(const CalibrationReport& report) {
  CalibrationMap map;
  const std::vector<glm::dvec3> places = error_places(report);
  set_grid(report, places, map);
  set_heights(report, places, map);
  const auto* covariance =
      report.rig.covariance.values.empty() ? nullptr : &report.rig.covariance;
  map.places =
      error_map(report.rig.cameras, covariance, map.grid, report.corner_sigma_px);
  const double height_m = map.grid.heights_m[map.grid.heights_m.size() / 2];
  // Uses the point at which the cameras look, if it is defined and they see it; otherwise
  // the positions of the board.
  const ErrorMapGrid before = grid_before(report.rig.cameras);
  const glm::dvec3 looked_at = 0.5 * (before.min_in_world + before.max_in_world);
  map.middle_in_world = {looked_at.x, height_m, looked_at.z};
  if (report.has_floor) {
    map.middle_error_m = error_at(report, map.grid, map.middle_in_world);
  }
  if (!map.middle_error_m && !places.empty()) {
    map.middle_in_world = {along(places, 0, 0.5), height_m, along(places, 2, 0.5)};
    map.middle_error_m = error_at(report, map.grid, map.middle_in_world);
  }
  std::vector<double> distances_m;
  for (const Camera& camera : report.rig.cameras) {
    distances_m.push_back(glm::distance(centre_in_world(camera), map.middle_in_world));
  }
  map.distance_m = median(std::move(distances_m));
  return map;
}

}  // namespace marey::calib
