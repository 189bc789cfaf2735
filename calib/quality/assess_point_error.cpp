// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_point_error.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "calib/quality/assess_residuals.h"
#include "calib/quality/calibration_limits.h"

namespace marey::calib {
namespace {

double fair_error_m(const CalibrationReport& report) {
  return limits_of(report).error_m[0];
}

double poor_error_m(const CalibrationReport& report) {
  return limits_of(report).error_m[1];
}

void assess_middle(FindingCollector& list) {
  const CalibrationMap& map = list.report.map;
  const std::string heights =
      list.report.has_floor
          ? "between ankle and shoulder height"
          : "at the heights the " + std::string(list.target()) + " was held";
  if (!map.middle_error_m) {
    list.add(
        Severity::kPoor,
        "unseen",
        "all cameras",
        format_text("fewer than two of them see the middle of the volume (x %.1f, z %.1f "
                    "m) ",
                    map.middle_in_world.x,
                    map.middle_in_world.z) +
            heights,
        "point the cameras at one place, or check that they were not moved");
    return;
  }
  if (*map.middle_error_m <= fair_error_m(list.report)) return;
  bool any_lag = false;
  for (std::size_t c = 0; c < list.report.cameras.size(); ++c) {
    any_lag = any_lag || has_significant_lag(list.report, c);
  }
  list.add(severity_of(*map.middle_error_m, poor_error_m(list.report)),
           "error",
           "all cameras",
           format_text("the expected error of a point in the middle of the volume is "
                       "%.1f mm ",
                       1e3 * *map.middle_error_m) +
               heights +
               format_text(" (good: under %.1f)", 1e3 * fair_error_m(list.report)),
           (any_lag ? "synchronize the cameras, then show the " : "show the ") +
               std::string(list.target()) +
               " longer, nearer and more tilted, and to several cameras at once; see "
               "which camera has the largest sigma");
}

/// Returns the side of the map with large errors as text; empty if errors are large
/// everywhere.
std::string side_of(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 way = to - from;
  if (std::hypot(way.x, way.z) < 0.2) return "";
  if (std::abs(way.x) > std::abs(way.z))
    return way.x > 0.0 ? " towards +x" : " towards -x";
  return way.z > 0.0 ? " towards +z" : " towards -z";
}

void assess_volume(FindingCollector& list) {
  const CalibrationMap& map = list.report.map;
  if (!map.middle_error_m) return;
  const double limit = std::max(fair_error_m(list.report), 3.0 * *map.middle_error_m);
  const std::size_t level = map.grid.heights_m.size() / 2;
  const std::size_t count = map.places.size() / map.grid.heights_m.size();
  int near = 0;
  int seen = 0;
  int far = 0;
  glm::dvec3 sum{0.0};
  // The area of a subject: within two metres, or two thirds of the cameras' distance.
  const double reach_m = std::min(2.0, 0.67 * map.distance_m);
  for (std::size_t i = level * count; i < (level + 1) * count; ++i) {
    const ErrorMapPlace& place = map.places[i];
    if (glm::distance(place.p_in_world, map.middle_in_world) > reach_m) continue;
    ++near;
    if (!place.error_m) continue;
    ++seen;
    if (*place.error_m <= limit) continue;
    ++far;
    sum += place.p_in_world;
  }
  if (seen == 0) return;
  if (far > 0.2 * seen) {
    list.add(
        Severity::kFair,
        "volume",
        "all cameras",
        format_text("in %.0f %% of the area that two cameras see within %.1f m of the "
                    "middle, the expected error is above %.0f mm",
                    100.0 * far / seen,
                    reach_m,
                    1e3 * limit) +
            side_of(map.middle_in_world, sum / static_cast<double>(far)),
        "let a camera look there from the side, or show more of the " +
            std::string(list.target()) + " there; see the map in calibration.html");
  }
  if (list.report.has_floor && seen < 0.6 * near) {
    list.add(
        Severity::kNote,
        "seen",
        "all cameras",
        format_text("two cameras see %.0f %% of the places at hip height within %.1f m "
                    "of the middle",
                    100.0 * seen / near,
                    reach_m),
        "stay where the map in calibration.html is coloured, or turn the cameras");
  }
}

/// Compares even and odd frames. Differences within the sigma are part of the expected
/// error, which considers that a distant camera with a longer lens has the same image.
void assess_halves(FindingCollector& list, std::size_t c, double apart_m) {
  constexpr double kFairRatio = 2.0;
  constexpr double kPoorRatio = 4.0;
  // The error of each half is sqrt(2) times that of the whole, their difference another
  // sqrt(2) times; there are three coordinates.
  const double typical_m =
      2.0 * std::sqrt(3.0) * list.report.rig.quality[c].centre_sigma_m;
  if (apart_m <= kFairRatio * typical_m || apart_m <= 2.0 * fair_error_m(list.report)) {
    return;
  }
  const bool is_poor =
      apart_m > kPoorRatio * typical_m && apart_m > 2.0 * poor_error_m(list.report);
  list.add(is_poor ? Severity::kPoor : Severity::kFair,
           "halves",
           list.camera(c),
           format_text(
               "its places from the even and from the odd frames are %.0f mm apart "
               "(expected: %.0f mm): its real error is larger than its sigma",
               1e3 * apart_m,
               1e3 * typical_m),
           "check that it was not touched while the " + std::string(list.target()) +
               " was shown, and show it longer, together with another camera")
      .measured(1e3 * apart_m, 1e3 * typical_m, "mm");
}

/// Compares the first half of the recording with the second.
void assess_halves_in_time(FindingCollector& list, std::size_t c) {
  const CrossValidation& check = *list.report.rig.cross_validation;
  if (c >= check.time_apart_m.size() || !(check.time_expected_m[c] > 0.0)) return;
  constexpr double kFairRatio = 2.0;
  constexpr double kPoorRatio = 3.0;
  const double apart_m = check.time_apart_m[c];
  const double ratio = apart_m / check.time_expected_m[c];
  if (ratio <= kFairRatio || apart_m <= fair_error_m(list.report)) return;
  const bool is_poor = ratio > kPoorRatio && apart_m > poor_error_m(list.report);
  list.add(is_poor ? Severity::kPoor : Severity::kFair,
           "halves",
           list.camera(c),
           format_text(
               "its places from the first and from the second half of the recording are "
               "%.0f mm apart (expected: %.0f mm): it was moved, its clock or its lens "
               "changed, or a half shows too little (its sigma is enlarged by that "
               "ratio)",
               1e3 * apart_m,
               1e3 * check.time_expected_m[c]),
           "check that nothing was touched or refocused while the " +
               std::string(list.target()) +
               " was shown, and show it to every camera early and late");
}

void assess_held_out(FindingCollector& list) {
  const auto& check = list.report.rig.cross_validation;
  if (!check) return;
  if (check->held_out_rms_px > 1.5 * check->seen_rms_px && check->held_out_rms_px > 0.3) {
    list.add(check->held_out_rms_px > 3.0 * check->seen_rms_px &&
                     check->held_out_rms_px > 1.0
                 ? Severity::kPoor
                 : Severity::kFair,
             "held-out",
             "all cameras",
             format_text("their error is %.2f px in frames that were not used for the "
                         "calibration, and %.2f px in the others",
                         check->held_out_rms_px,
                         check->seen_rms_px),
             std::string("show the ") + list.target() +
                 " in more places and postures: "
                 "the recording is too short for so many unknowns")
        .measured(check->held_out_rms_px, std::nullopt, "px");
  }
  for (std::size_t c = 0; c < list.report.cameras.size(); ++c) {
    const double scale = pixel_scale(list.report.rig.cameras[c]);
    if (const auto& px = check->held_out_camera_px[c];
        px && *px > 2.0 * scale && *px > 3.0 * list.report.rig.median_px) {
      list.add(severity_of(*px, 6.0 * scale),
               "held-out",
               list.camera(c),
               format_text(
                   "its error is %.1f px if the place of the %s is computed from the "
                   "other cameras alone, and %.2f px with its own views",
                   *px,
                   list.target(),
                   list.report.cameras[c].median_px),
               format_text(
                   list.report.has_clocks
                       ? "check that its video skips no frames, and that it was not "
                         "moved; hold the %s where it and two others see it"
                       : "if its video starts at another time, set clocks = "
                         "\"offsets\" under [calibration] in session.toml; check that "
                         "it was not moved, and hold the %s where it and two others "
                         "see it",
                   list.target()))
          .measured(*px, std::nullopt, "px");
    }
    assess_halves(list, c, check->centre_apart_m[c]);
    assess_halves_in_time(list, c);
  }
}

}  // namespace

void assess_point_error(FindingCollector& list) {
  assess_middle(list);
  assess_volume(list);
  assess_held_out(list);
}

}  // namespace marey::calib
