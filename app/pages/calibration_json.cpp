// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pages/calibration_json.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"
#include "app/shell/findings.h"
#include "app/shell/lens_words.h"
#include "calib/quality/assess_calibration.h"
#include "calib/quality/calibration_limits.h"
#include "calib/quality/calibration_report.h"
#include "core/base/angle.h"
#include "core/base/quantile.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLens = Intrinsics::kParameterCount;

Json px_json(double value_px) {
  return rounded(value_px, 3);
}
Json mm_json(double value_m) {
  return rounded(1e3 * value_m, 2);
}
Json mm_json(const std::optional<double>& value_m) {
  return value_m ? mm_json(*value_m) : Json(nullptr);
}
Json percent(double share) {
  return rounded(100.0 * share, 1);
}
Json metres_json(const glm::dvec3& p) {
  return {rounded(p.x, 4), rounded(p.y, 4), rounded(p.z, 4)};
}

/// Rounds a value to the last significant figures of its sigma.
double to_sigma(double value, double sigma) {
  if (!(sigma > 0.0)) return rounded(value, 6);
  const int decimals = static_cast<int>(std::ceil(1.5 - std::log10(sigma)));
  return rounded(value, std::clamp(decimals, 0, 9));
}

/// Returns every parameter of a camera with its standard deviation.
Json parameters(const calib::CalibrationReport& report, std::size_t c) {
  const calib::CalibratedRig& rig = report.rig;
  const Camera& camera = rig.cameras[c];
  Json out = Json::array();
  const auto add = [&](const char* name, double value, double sigma, const char* unit) {
    out.push_back({{"name", name},
                   {"value", to_sigma(value, sigma)},
                   {"sigma", to_sigma(sigma, sigma)},
                   {"unit", unit}});
  };
  const auto sigma = [&](std::size_t i) {
    if (rig.covariance.values.empty()) return 0.0;
    const std::size_t at = calib::RigCovariance::kPerCamera * c + i;
    return std::sqrt(std::max(0.0, rig.covariance.at(at, at)));
  };
  static constexpr std::array<const char*, 4> kPinhole{
      "focal_x", "focal_y", "centre_x", "centre_y"};
  static constexpr std::array<const char*, 8> kBrown{
      "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  static constexpr std::array<const char*, 4> kFisheye{"k1", "k2", "k3", "k4"};
  const auto values = camera.intrinsics.parameters();
  const LensModel lens = camera.intrinsics.lens;
  for (std::size_t i = 0; i < 4 + distortion_terms(lens); ++i) {
    const char* name = i < 4                         ? kPinhole[i]
                       : lens == LensModel::kFisheye ? kFisheye[i - 4]
                                                     : kBrown[i - 4];
    add(name, values[i], sigma(i), i < 4 ? "px" : "");
  }
  const RigidTransform world_from_camera = inverse(camera.camera_from_world);
  const glm::dvec3 turn = rotation_vector(world_from_camera.rotation);
  static constexpr std::array<const char*, 3> kTurns{
      "rotation_x", "rotation_y", "rotation_z"};
  static constexpr std::array<const char*, 3> kPlaces{"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    add(kTurns[k],
        kDegreesPerRadian * turn[i],
        kDegreesPerRadian * sigma(kLens + k),
        "deg");
  }
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    add(kPlaces[k],
        1e3 * world_from_camera.translation[i],
        1e3 * sigma(kLens + 3 + k),
        "mm");
  }
  if (report.has_clocks) {
    const calib::SolvedClock& clock = rig.clocks[c];
    add("offset", 1e3 * clock.offset_s, 1e3 * clock.offset_sigma_s, "ms");
    add("drift", 1e6 * clock.drift, 1e6 * clock.drift_sigma, "ppm");
    add("line_delay", 1e6 * clock.line_delay_s, 1e6 * clock.line_delay_sigma_s, "us");
  }
  return out;
}

/// Returns the covariance of the camera centre as three rows of the symmetric matrix.
Json centre_covariance_mm2(const calib::CalibrationReport& report, std::size_t c) {
  const calib::RigCovariance& covariance = report.rig.covariance;
  Json rows = Json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    Json row = Json::array();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = calib::RigCovariance::kPerCamera * c + kLens + 3;
      row.push_back(covariance.values.empty()
                        ? 0.0
                        : rounded(1e6 * covariance.at(at + i, at + k), 6));
    }
    rows.push_back(row);
  }
  return rows;
}

Json lag_json(const calib::CalibrationReport& report,
              const calib::CameraMeasures& measures) {
  if (!measures.lag || !(report.rate_hz > 0.0)) return nullptr;
  const double ms = 1e3 / report.rate_hz;
  return {{"lag_ms", rounded(ms * measures.lag->frames, 3)},
          {"sigma_ms", rounded(ms * measures.lag->sigma_frames, 3)},
          {"explained_px", px_json(measures.lag->explained_px)}};
}

Json camera_json(const calib::CalibrationReport& report, std::size_t c) {
  const Camera& camera = report.rig.cameras[c];
  const CameraQuality& quality = report.rig.quality[c];
  const calib::CameraMeasures& measures = report.cameras[c];
  const Intrinsics& k = camera.intrinsics;
  const RigidTransform world_from_camera = inverse(camera.camera_from_world);
  const auto& halves = measures.half_coverage;
  return {
      {"name", camera.name},
      {"width_px", k.width_px},
      {"height_px", k.height_px},
      {"lens", lens_word(k.lens)},
      {"focal_px", {px_json(k.focal_px.x), px_json(k.focal_px.y)}},
      {"focal_sigma_px", px_json(quality.focal_sigma_px)},
      {"centre_px", {px_json(k.centre_px.x), px_json(k.centre_px.y)}},
      {"rms_px", px_json(quality.rms_px)},
      {"inlier_rms_px", px_json(measures.inlier_rms_px)},
      {"median_px", px_json(measures.median_px)},
      {"p95_px", px_json(quality.p95_px)},
      {"pattern_px", px_json(measures.pattern_px)},
      {"floor_median_px",
       measures.floor_median_px ? px_json(*measures.floor_median_px) : Json(nullptr)},
      {"clock_lag", lag_json(report, measures)},
      {"views", quality.views},
      {"instants", measures.instants},
      {"corners", quality.corners},
      {"outlier_corners", measures.outlier_corners},
      {"coverage_percent", percent(quality.coverage)},
      {"half_coverage_percent",
       {{"left", percent(halves[0])},
        {"right", percent(halves[1])},
        {"upper", percent(halves[2])},
        {"lower", percent(halves[3])}}},
      {"coverage_columns", calib::kCoverageColumns},
      {"coverage_corners", measures.cells},
      {"tilt_p90_deg",
       measures.tilts.empty()
           ? Json(nullptr)
           : Json(rounded(kDegreesPerRadian * measures.p90_tilt_rad, 1))},
      {"centre_in_world_m", metres_json(world_from_camera.translation)},
      {"centre_sigma_mm", mm_json(quality.centre_sigma_m)},
      {"centre_covariance_mm2", centre_covariance_mm2(report, c)},
      {"right_in_world", metres_json(world_from_camera.rotation * glm::dvec3(1, 0, 0))},
      {"down_in_world", metres_json(world_from_camera.rotation * glm::dvec3(0, 1, 0))},
      {"forward_in_world", metres_json(world_from_camera.rotation * glm::dvec3(0, 0, 1))},
      {"parameters", parameters(report, c)}};
}

Json map_json(const calib::CalibrationMap& map) {
  const auto columns = static_cast<std::size_t>(map.grid.columns());
  const std::size_t count = map.places.size() / map.grid.heights_m.size();
  Json heights = Json::array();
  for (std::size_t h = 0; h < map.grid.heights_m.size(); ++h) {
    std::vector<double> errors_m;
    Json rows = Json::array();
    for (std::size_t i = 0; i < count; ++i) {
      const calib::ErrorMapPlace& place = map.places[h * count + i];
      if (i % columns == 0) rows.push_back(Json::array());
      rows.back().push_back(mm_json(place.error_m));
      if (place.error_m) errors_m.push_back(*place.error_m);
    }
    const double seen =
        count > 0 ? static_cast<double>(errors_m.size()) / static_cast<double>(count) : 0;
    heights.push_back(
        {{"height", map.height_names[h]},
         {"height_m", rounded(map.grid.heights_m[h], 3)},
         {"seen_percent", percent(seen)},
         {"median_error_mm",
          errors_m.empty() ? Json(nullptr) : mm_json(median(errors_m))},
         {"p95_error_mm",
          errors_m.empty() ? Json(nullptr) : mm_json(quantile(errors_m, 0.95))},
         {"error_mm", rows}});
  }
  return {{"x_from_m", rounded(map.grid.min_in_world.x, 4)},
          {"z_from_m", rounded(map.grid.min_in_world.z, 4)},
          {"step_m", rounded(map.grid.step_m, 6)},
          {"heights", heights}};
}

Json cross_validation_json(const calib::CalibrationReport& report) {
  const auto& check = report.rig.cross_validation;
  if (!check) return nullptr;
  Json cameras = Json::array();
  const bool has_time = check->time_apart_m.size() == report.rig.cameras.size();
  for (std::size_t c = 0; c < report.rig.cameras.size(); ++c) {
    cameras.push_back(
        {{"name", report.rig.cameras[c].name},
         {"time_apart_mm", has_time ? mm_json(check->time_apart_m[c]) : Json(nullptr)},
         {"time_expected_mm",
          has_time ? mm_json(check->time_expected_m[c]) : Json(nullptr)},
         {"centre_apart_mm", mm_json(check->centre_apart_m[c])},
         {"turn_apart_deg", rounded(kDegreesPerRadian * check->turn_apart_rad[c], 4)},
         {"focal_apart_px", px_json(check->focal_apart_px[c])},
         {"held_out_median_px",
          check->held_out_camera_px[c] ? px_json(*check->held_out_camera_px[c])
                                       : Json(nullptr)}});
  }
  return {{"seen_rms_px", px_json(check->seen_rms_px)},
          {"held_out_rms_px", px_json(check->held_out_rms_px)},
          {"cameras", cameras}};
}

Json move_json(const calib::CalibrationReport& report) {
  const auto& move = report.rig.apparent_move;
  if (!move) return nullptr;
  return {{"camera", report.rig.cameras[index(move->camera)].name},
          {"from_frame", move->from_frame ? Json(*move->from_frame) : Json(nullptr)},
          {"moved_px", px_json(move->moved_px)},
          {"turn_deg", rounded(kDegreesPerRadian * move->turn_rad, 4)},
          {"shift_mm", mm_json(move->shift_m)},
          {"rig_shift_mm", mm_json(move->rig_shift_m)},
          {"gain", rounded(move->gain, 0)}};
}

Json delay_json(const calib::CalibrationReport& report) {
  const auto& delays = report.rig.apparent_line_delays;
  if (!delays) return nullptr;
  Json cameras = Json::array();
  for (std::size_t c = 0; c < delays->delay_s.size(); ++c) {
    cameras.push_back({{"name", report.rig.cameras[c].name},
                       {"line_delay_us", rounded(1e6 * delays->delay_s[c], 2)},
                       {"sigma_us", rounded(1e6 * delays->sigma_s[c], 2)},
                       {"shift_mm", mm_json(delays->shift_m[c])}});
  }
  return {{"gain", rounded(delays->gain, 0)}, {"cameras", cameras}};
}

Json outlier_json(const calib::CalibrationReport& report) {
  Json out = Json::array();
  for (const calib::OutlierFrame& frame : report.rig.outlier_frames) {
    out.push_back(
        {{"camera", report.rig.cameras[index(frame.camera)].name},
         {"frame",
          frame.frame == calib::kFloorInstant ? Json(nullptr) : Json(frame.frame)},
         {"left_out", frame.sightings},
         {"of", frame.seen},
         {"median_error_px", px_json(frame.median_error_px)}});
  }
  return out;
}

Json shared_json(const calib::CalibrationReport& report) {
  const std::size_t count = report.rig.cameras.size();
  Json rows = Json::array();
  if (report.rig.shared_views.size() != count * count) return rows;
  for (std::size_t a = 0; a < count; ++a) {
    Json row = Json::array();
    for (std::size_t b = 0; b < count; ++b) {
      row.push_back(report.rig.shared_views[a * count + b]);
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

Json calibration_json(const calib::CalibrationReport& report) {
  const calib::CalibratedRig& rig = report.rig;
  Json cameras = Json::array();
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    cameras.push_back(camera_json(report, c));
  }
  Json warp = nullptr;
  if (rig.warp_m) {
    warp = {
        mm_json((*rig.warp_m)[0]), mm_json((*rig.warp_m)[1]), mm_json((*rig.warp_m)[2])};
  }
  const calib::CalibrationLimits limits = calib::limits_of(report);
  return {
      {"session", report.session},
      {"marey_version", report.version},
      {"target", report.target},
      {"verdict", calib::verdict_of(report)},
      {"findings", findings_json(report.findings)},
      {"limits",
       {{"error_mm", {mm_json(limits.error_m[0]), mm_json(limits.error_m[1])}},
        {"residual_px", limits.residual_px},
        {"coverage_percent", {percent(limits.coverage[0]), percent(limits.coverage[1])}},
        {"shared_instants", limits.shared_instants}}},
      {"middle_error_mm", mm_json(report.map.middle_error_m)},
      {"middle_in_world_m", metres_json(report.map.middle_in_world)},
      {"distance_m", rounded(report.map.distance_m, 3)},
      {"has_floor", report.has_floor},
      {"board_on_floor", report.board_on_floor},
      {"rms_px", px_json(rig.rms_px)},
      {"median_px", px_json(rig.median_px)},
      {"inlier_rms_px", px_json(rig.inlier_rms_px)},
      {"corner_sigma_px", px_json(report.corner_sigma_px)},
      {"sigma_factor", rounded(rig.sigma_factor, 3)},
      {"sightings", rig.sightings},
      {"outliers", rig.outliers},
      {"warp_mm", warp},
      {"shared_views", shared_json(report)},
      {"cameras", cameras},
      {"cross_validation", cross_validation_json(report)},
      {"apparent_move", move_json(report)},
      {"apparent_line_delays", delay_json(report)},
      {"outlier_frames", outlier_json(report)},
      {"error_map", map_json(report.map)}};
}

std::string calibration_json_text(const calib::CalibrationReport& report) {
  return calibration_json(report).dump(1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

}  // namespace marey::app
