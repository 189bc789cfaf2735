// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/plan/plan_json.h"

#include <array>
#include <cstdio>
#include <optional>

#include <nlohmann/json.hpp>

#include "app/pages/report_json.h"
#include "core/camera.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

Json percent(double share) {
  return rounded(100.0 * share, 1);
}

Json mm(const std::optional<double>& value_m) {
  return value_m ? Json(rounded(1e3 * *value_m, 3)) : Json(nullptr);
}

Json spread(const std::optional<calib::MedianAndP95>& error_m, bool is_median) {
  if (!error_m) return nullptr;
  return rounded(1e3 * (is_median ? error_m->median : error_m->p95), 3);
}

Json point(const glm::dvec3& p) {
  return {rounded(p.x, 4), rounded(p.y, 4), rounded(p.z, 4)};
}

Json cameras_of(const PlanReport& report) {
  Json out = Json::array();
  for (std::size_t c = 0; c < report.cameras.size(); ++c) {
    const Camera& camera = report.cameras[c];
    const Intrinsics& k = camera.intrinsics;
    const RigidTransform world_from_camera = inverse(camera.camera_from_world);
    Json sigma_mm;
    if (c < report.centre_sigma_m.size()) {
      sigma_mm = rounded(1e3 * report.centre_sigma_m[c], 2);
    }
    out.push_back(
        {{"name", camera.name},
         {"width_px", k.width_px},
         {"height_px", k.height_px},
         {"focal_px", {rounded(k.focal_px.x, 2), rounded(k.focal_px.y, 2)}},
         {"centre_in_world_m", point(world_from_camera.translation)},
         {"centre_sigma_mm", sigma_mm},
         {"forward_in_world", point(world_from_camera.rotation * glm::dvec3(0, 0, 1))}});
  }
  return out;
}

/// Returns cells such as "   12.3", or blanks and a dash of the same width.
std::string cell(const char* format, int width, const std::optional<double>& value) {
  char text[32];
  if (!value) {
    std::snprintf(text, sizeof text, "%*s", width, "-");
  } else {
    std::snprintf(text, sizeof text, format, width, *value);
  }
  return text;
}

std::optional<double> in_mm(const std::optional<calib::MedianAndP95>& error_m,
                            double calib::MedianAndP95::*which) {
  if (!error_m) return std::nullopt;
  return 1e3 * (*error_m).*which;
}

Json body_of(const PlanReport& report) {
  const calib::BodyPlan& body = report.body;
  Json joints = Json::array();
  for (const calib::PlannedJoint& joint : body.joints) {
    joints.push_back({{"name", joint_name(joint.bone)},
                      {"measured_percent", percent(joint.measured_share)},
                      {"median_mm", rounded(1e3 * joint.error_m.median, 3)},
                      {"p95_mm", rounded(1e3 * joint.error_m.p95, 3)},
                      {"lasting_mm", rounded(1e3 * joint.lasting_error_m, 3)}});
  }
  Json stands = Json::array();
  for (const calib::PlannedStand& stand : body.stands) {
    stands.push_back({{"p_on_floor_m", point(stand.p_on_floor)},
                      {"measured_percent", percent(stand.measured_share)},
                      {"joint_mm", mm(stand.error_m)}});
  }
  const bool found = !body.joints.empty();
  return {{"tags", report.tags_worn},
          {"found_percent", percent(body.found_share)},
          {"measured_percent", percent(body.measured_share)},
          {"tags_seen_percent", percent(body.views_share)},
          {"tags_seen_by_two_percent", percent(body.twice_share)},
          {"median_mm", found ? Json(rounded(1e3 * body.error_m.median, 3)) : Json()},
          {"p95_mm", found ? Json(rounded(1e3 * body.error_m.p95, 3)) : Json()},
          {"joints", joints},
          {"stand_step_m", rounded(report.stand_step_m, 4)},
          {"stands", stands}};
}

/// Returns the lines of the table about the body.
std::string body_table(const PlanReport& report) {
  const calib::BodyPlan& body = report.body;
  char line[160];
  std::snprintf(line,
                sizeof line,
                "\na body with %d tags walks: found in %.0f %% of frames\n"
                "joint             measured   error: median    95 %%    lasting part\n",
                report.tags_worn,
                100.0 * body.found_share);
  std::string out = line;
  for (const calib::PlannedJoint& joint : body.joints) {
    std::snprintf(line,
                  sizeof line,
                  "%-17s %6.0f %%  %12.1f %9.1f %10.1f mm\n",
                  joint_name(joint.bone).c_str(),
                  100.0 * joint.measured_share,
                  1e3 * joint.error_m.median,
                  1e3 * joint.error_m.p95,
                  1e3 * joint.lasting_error_m);
    out += line;
  }
  if (body.joints.empty()) return out;
  std::snprintf(line,
                sizeof line,
                "%-17s %6.0f %%  %12.1f %9.1f mm\n",
                "all",
                100.0 * body.measured_share,
                1e3 * body.error_m.median,
                1e3 * body.error_m.p95);
  return out + line;
}

}  // namespace

std::string joint_name(HumanBone bone) {
  const auto& limbs = human_limbs();
  constexpr std::array<std::array<const char*, 3>, 2> kNames{
      {{"shoulder", "elbow", "wrist"}, {"hip", "knee", "ankle"}}};
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    const std::array<HumanBone, 3> bones{limbs[i].upper, limbs[i].lower, limbs[i].end};
    for (std::size_t k = 0; k < bones.size(); ++k) {
      if (bones[k] != bone) continue;
      return std::string(i % 2 == 0 ? "left " : "right ") + kNames[i / 2][k];
    }
  }
  return std::string(name(bone));
}

Json plan_json(const PlanReport& report) {
  Json heights = Json::array();
  for (std::size_t i = 0; i < report.plan.heights.size(); ++i) {
    const calib::PlannedHeight& h = report.plan.heights[i];
    heights.push_back({{"name", report.height_names[i]},
                       {"height_m", rounded(h.height_m, 3)},
                       {"seen_percent", percent(h.seen_share)},
                       {"measured_percent", percent(h.measured_share)},
                       {"tag_side_px", h.side_px ? Json(rounded(*h.side_px, 1)) : Json()},
                       {"tag_median_mm", spread(h.centre_error_m, true)},
                       {"tag_p95_mm", spread(h.centre_error_m, false)},
                       {"joint_median_mm", spread(h.joint_error_m, true)},
                       {"joint_p95_mm", spread(h.joint_error_m, false)}});
  }
  Json places = Json::array();
  for (const calib::PlannedPlace& place : report.plan.places) {
    places.push_back({{"p_in_world_m", point(place.p_in_world)},
                      {"seen_percent", percent(place.seen_share)},
                      {"measured_percent", percent(place.measured_share)},
                      {"tag_side_px", rounded(place.side_px, 1)},
                      {"tag_mm", mm(place.centre_error_m)},
                      {"joint_mm", mm(place.joint_error_m)}});
  }
  const calib::ErrorMapGrid& grid = report.grid;
  return {
      {"plan", report.name},
      {"tag_size_mm", rounded(1e3 * report.options.tag_size_m, 2)},
      {"stature_m", rounded(report.stature_m, 3)},
      {"lever_mm", rounded(1e3 * report.options.lever_m, 1)},
      {"least_m", {rounded(grid.min_in_world.x, 4), rounded(grid.min_in_world.z, 4)}},
      {"greatest_m", {rounded(grid.max_in_world.x, 4), rounded(grid.max_in_world.z, 4)}},
      {"step_m", rounded(grid.step_m, 4)},
      {"cameras", cameras_of(report)},
      {"cameras_known",
       report.centre_sigma_m.empty() ? "exactly"
                                     : (report.is_calibrated ? "calibrated" : "planned")},
      {"body", body_of(report)},
      {"heights", heights},
      {"places", places}};
}

std::string plan_table(const PlanReport& report) {
  std::string out =
      "                    tags seen by     side   error of a tag's    of a joint\n"
      "height               one    two     of tag   median    95 %    median    95 %\n";
  for (std::size_t i = 0; i < report.plan.heights.size(); ++i) {
    const calib::PlannedHeight& h = report.plan.heights[i];
    char start[48];
    std::snprintf(
        start, sizeof start, "%-10s %4.2f m", report.height_names[i].c_str(), h.height_m);
    using Spread = calib::MedianAndP95;
    out += start;
    out += cell("%*.0f %%", 6, 100.0 * h.seen_share);
    out += cell("%*.0f %%", 5, 100.0 * h.measured_share);
    out += cell(h.side_px ? "%*.0f px" : "%*.0f", h.side_px ? 8 : 11, h.side_px);
    out += cell("%*.2f", 9, in_mm(h.centre_error_m, &Spread::median));
    out += cell("%*.2f", 8, in_mm(h.centre_error_m, &Spread::p95));
    out += cell("%*.2f", 10, in_mm(h.joint_error_m, &Spread::median));
    out += cell("%*.2f mm", 8, in_mm(h.joint_error_m, &Spread::p95));
    out += '\n';
  }
  return out + body_table(report);
}

}  // namespace marey::app
