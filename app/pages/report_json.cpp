// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pages/report_json.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "app/shell/findings.h"
#include "core/base/assert.h"
#include "core/base/degrees.h"
#include "core/base/quantile.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMillimetresPerMetre = 1000.0;

double px(double value_px) {
  return rounded(value_px, 3);
}

double mm(double value_m) {
  return rounded(value_m * kMillimetresPerMetre, 2);
}

double percent(double part, double whole) {
  return whole > 0.0 ? rounded(100.0 * part / whole, 1) : 0.0;
}

Json metres(const glm::dvec3& p) {
  return {rounded(p.x, 4), rounded(p.y, 4), rounded(p.z, 4)};
}

/// Returns null if there are no values.
Json quantile_mm(const std::vector<double>& values_m, double share) {
  return values_m.empty() ? Json(nullptr) : Json(mm(quantile(values_m, share)));
}

/// Returns the sigmas of all joints and frames of the subject of a trial. [m]
void collect_sigmas(const ReportTrial& trial, std::vector<double>& sigmas_m) {
  if (trial.bodies.empty()) return;
  for (const auto& frame : trial.bodies.front().uncertainty) {
    for (const JointUncertainty& uncertainty : frame)
      sigmas_m.push_back(uncertainty.sigma_m);
  }
}

Json camera_json(const ReportCamera& camera) {
  const Intrinsics& k = camera.camera.intrinsics;
  const RigidTransform world_from_camera = inverse(camera.camera.camera_from_world);
  Json distortion = Json::array();
  for (std::size_t i = 0; i < distortion_terms(k.lens); ++i) {
    distortion.push_back(rounded(k.distortion[i], 6));
  }
  return {{"name", camera.camera.name},
          {"width_px", k.width_px},
          {"height_px", k.height_px},
          {"focal_px", {px(k.focal_px.x), px(k.focal_px.y)}},
          {"focal_sigma_px", px(camera.quality.focal_sigma_px)},
          {"centre_px", {px(k.centre_px.x), px(k.centre_px.y)}},
          {"distortion", distortion},
          {"centre_in_world_m", metres(world_from_camera.translation)},
          {"centre_sigma_mm", mm(camera.quality.centre_sigma_m)},
          {"right_in_world", metres(world_from_camera.rotation * glm::dvec3(1, 0, 0))},
          {"down_in_world", metres(world_from_camera.rotation * glm::dvec3(0, 1, 0))},
          {"forward_in_world", metres(world_from_camera.rotation * glm::dvec3(0, 0, 1))},
          {"rms_px", px(camera.quality.rms_px)},
          {"p95_px", px(camera.quality.p95_px)},
          {"coverage_percent", percent(camera.quality.coverage, 1.0)},
          {"views", camera.quality.views}};
}

Json calibration_json(const Report& report) {
  Json cameras = Json::array();
  for (const ReportCamera& camera : report.cameras) {
    cameras.push_back(camera_json(camera));
  }
  return {{"rms_px", px(report.calibration_rms_px)}, {"cameras", cameras}};
}

/// Returns the distance of every bone's joint from its parent joint.
Json bone_json(const Body& body) {
  Json bones = Json::array();
  for (const HumanBone bone : human_bones()) {
    const auto from = parent(bone);
    if (!from) continue;
    bones.push_back({{"from", name(*from)},
                     {"to", name(bone)},
                     {"length_mm", mm(glm::length(body.proportions[bone]))},
                     {"sigma_mm", mm(body.joint_centre_sigma_m[index(bone)])}});
  }
  return bones;
}

Json subject_json(const Report& report) {
  if (!report.subject) return nullptr;
  const Body& body = *report.subject;
  Json tags = Json::array();
  for (const PlacedTag& placed : body.tags) {
    tags.push_back({{"id", number(placed.tag.id)},
                    {"segment", name(placed.tag.segment)},
                    {"size_mm", mm(placed.tag.size_m)},
                    {"sigma_mm", mm(placed.sigma_m)},
                    {"sigma_deg", rounded(placed.sigma_rad * kDegreesPerRadian, 2)},
                    {"sightings", placed.sightings}});
  }
  return {{"name", body.name},
          {"stature_m", rounded(body.stature_m, 3)},
          {"mass_kg", body.mass_kg ? Json(rounded(*body.mass_kg, 1)) : Json(nullptr)},
          {"rms_px", px(report.subject_rms_px)},
          {"limb_ratio", rounded(report.limb_ratio, 3)},
          {"bones", bone_json(body)},
          {"tags", tags},
          {"unplaced_tags", report.unplaced_tags}};
}

const char* clock_word(ClockSource clock) {
  switch (clock) {
    case ClockSource::kReference:
      return "reference";
    case ClockSource::kGiven:
      return "given";
    case ClockSource::kEstimated:
      return "estimated";
  }
  return "";
}

Json trial_camera_json(const ReportTrial& trial) {
  Json cameras = Json::array();
  for (const ReportTrialCamera& camera : trial.cameras) {
    cameras.push_back({{"name", camera.name},
                       {"rms_px", px(camera.rms_px)},
                       {"median_px", px(camera.median_px)},
                       {"corners", camera.corners},
                       {"offset_ms", rounded(1000.0 * camera.offset_s, 2)},
                       {"clock", clock_word(camera.clock)},
                       {"unsure_sightings", camera.dropped.unsure},
                       {"doubled_sightings", camera.dropped.duplicated}});
  }
  return cameras;
}

Json tag_json(const ReportTrial& trial) {
  Json tags = Json::array();
  for (const ReportTag& tag : trial.tags) {
    const auto unseen =
        std::count(tag.cameras_seeing.begin(), tag.cameras_seeing.end(), 0);
    const auto frames = static_cast<int>(tag.cameras_seeing.size());
    const int seen = frames - static_cast<int>(unseen);
    tags.push_back(
        {{"id", tag.id},
         {"segment", tag.segment},
         {"seen_frames", seen},
         {"seen_percent", percent(seen, frames)},
         {"rms_px", tag.rms_px ? Json(px(*tag.rms_px)) : Json(nullptr)},
         {"median_px", tag.median_px ? Json(px(*tag.median_px)) : Json(nullptr)}});
  }
  return tags;
}

Json gap_json(const ReportTrial& trial) {
  Json gaps = Json::array();
  for (const ReportGap& gap : trial.gaps) {
    const int frames = gap.last_frame - gap.first_frame + 1;
    gaps.push_back({{"segment", gap.segment},
                    {"first_frame", gap.first_frame},
                    {"last_frame", gap.last_frame},
                    {"duration_s", rounded(frames / trial.rate.hz, 3)},
                    {"bridged_as", name(gap.bridged_as)}});
  }
  return gaps;
}

Json joint_json(const ReportTrial& trial) {
  Json joints = Json::array();
  if (trial.bodies.empty()) return joints;
  const ReportBody& subject = trial.bodies.front();
  for (std::size_t j = 0; j < subject.motion.skeleton.joints.size(); ++j) {
    std::vector<double> sigmas_m;
    std::map<Source, int> frames;
    for (const auto& frame : subject.uncertainty) {
      if (j >= frame.size()) continue;
      sigmas_m.push_back(frame[j].sigma_m);
      ++frames[frame[j].source];
    }
    const auto total = static_cast<double>(sigmas_m.size());
    Json joint{{"joint", subject.motion.skeleton.joints[j].name},
               {"median_sigma_mm", quantile_mm(sigmas_m, 0.5)},
               {"p95_sigma_mm", quantile_mm(sigmas_m, 0.95)}};
    for (const Source source :
         {Source::kMeasured, Source::kRepaired, Source::kInferred}) {
      joint[std::string(name(source)) + "_percent"] = percent(frames[source], total);
    }
    joints.push_back(std::move(joint));
  }
  return joints;
}

Json avatar_json(const ReportTrial& trial) {
  Json avatars = Json::array();
  for (std::size_t i = 1; i < trial.bodies.size(); ++i) {
    const ReportBody& body = trial.bodies[i];
    avatars.push_back(
        {{"name", body.name},
         {"slide_before_cm_per_s", rounded(body.slide_before_cm_per_s, 2)},
         {"slide_after_cm_per_s", rounded(body.slide_after_cm_per_s, 2)},
         {"penetration_mm", rounded(body.penetration_mm, 2)},
         {"penetration_part",
          body.penetration_part.empty() ? Json(nullptr) : Json(body.penetration_part)},
         {"penetration_frame",
          body.penetration_frame ? Json(*body.penetration_frame) : Json(nullptr)},
         {"source_depth_mm", rounded(body.source_depth_mm, 2)},
         {"legs_deg", rounded(body.legs_deg, 2)},
         {"arms_deg", rounded(body.arms_deg, 2)},
         {"trunk_deg", rounded(body.trunk_deg, 2)},
         {"problems", messages(body.problems, Severity::kNote)},
         {"files", body.files}});
  }
  return avatars;
}

Json residuals_over_time(const ReportTrial& trial) {
  Json values = Json::array();
  for (const double value_px : trial.frame_rms_px) values.push_back(px(value_px));
  return values;
}

Json trial_json(const ReportTrial& trial) {
  std::vector<double> sigmas_m;
  collect_sigmas(trial, sigmas_m);
  return {
      {"name", trial.name},
      {"rate_hz", rounded(trial.rate.hz, 4)},
      {"first_frame", trial.first_frame},
      {"frames", trial.frames},
      {"frames_solved", trial.frames_solved},
      {"solved_percent", percent(trial.frames_solved, trial.frames)},
      {"rms_px", px(trial.rms_px)},
      {"median_px", px(trial.median_px)},
      {"frame_rms_px", residuals_over_time(trial)},
      {"joint_sigma_median_mm", quantile_mm(sigmas_m, 0.5)},
      {"joint_sigma_p95_mm", quantile_mm(sigmas_m, 0.95)},
      {"files",
       trial.bodies.empty() ? std::vector<std::string>{} : trial.bodies.front().files},
      {"cameras", trial_camera_json(trial)},
      {"tags", tag_json(trial)},
      {"gaps", gap_json(trial)},
      {"joints", joint_json(trial)},
      {"avatars", avatar_json(trial)}};
}

/// Returns the root mean square over the corners of all trials.
double solve_rms_px(const Report& report) {
  double squares = 0.0;
  double corners = 0.0;
  for (const ReportTrial& trial : report.trials) {
    double here = 0.0;
    for (const ReportTrialCamera& camera : trial.cameras) here += camera.corners;
    squares += here * trial.rms_px * trial.rms_px;
    corners += here;
  }
  return corners > 0.0 ? std::sqrt(squares / corners) : 0.0;
}

/// Returns the worst camera, tag, frame and joint, which averages may hide.
Json worst_json(const Report& report) {
  Json worst{
      {"camera", nullptr}, {"tag", nullptr}, {"frame", nullptr}, {"joint", nullptr}};
  const auto raise = [&](const char* kind, double value, Json row) {
    if (worst[kind].is_null() || value > worst[kind].at("value").get<double>()) {
      row["value"] = value;
      worst[kind] = std::move(row);
    }
  };
  for (const ReportTrial& trial : report.trials) {
    for (const ReportTrialCamera& camera : trial.cameras) {
      if (camera.corners == 0) continue;
      raise("camera", px(camera.rms_px), {{"trial", trial.name}, {"name", camera.name}});
    }
    for (const ReportTag& tag : trial.tags) {
      if (!tag.median_px || tag.corners == 0) continue;
      raise("tag",
            px(*tag.median_px),
            {{"trial", trial.name}, {"name", tag.id}, {"segment", tag.segment}});
    }
    for (std::size_t i = 0; i < trial.frame_rms_px.size(); ++i) {
      raise("frame",
            px(trial.frame_rms_px[i]),
            {{"trial", trial.name}, {"name", trial.first_frame + static_cast<int>(i)}});
    }
    for (const Json& joint : joint_json(trial)) {
      if (!joint.at("median_sigma_mm").is_number()) continue;
      raise("joint",
            joint.at("median_sigma_mm").get<double>(),
            {{"trial", trial.name}, {"name", joint.at("joint")}});
    }
  }
  return worst;
}

Json summary_json(const Report& report) {
  int frames = 0;
  int solved = 0;
  double processing_s = 0.0;
  std::vector<double> sigmas_m;
  for (const ReportTrial& trial : report.trials) {
    frames += trial.frames;
    solved += trial.frames_solved;
    collect_sigmas(trial, sigmas_m);
  }
  for (const ReportTiming& timing : report.timings) processing_s += timing.seconds;
  const double recorded_s = report.recorded_s;
  // Without results there is nothing that a finding could make unreliable.
  std::vector<std::string> poor;
  if (!report.trials.empty()) poor = messages(report.findings, Severity::kPoor);
  return {{"trials", report.trials.size()},
          {"frames", frames},
          {"frames_solved", solved},
          {"solved_percent", percent(solved, frames)},
          {"calibration_rms_px", px(report.calibration_rms_px)},
          {"solve_rms_px", px(solve_rms_px(report))},
          {"joint_sigma_median_mm", quantile_mm(sigmas_m, 0.5)},
          {"joint_sigma_p95_mm", quantile_mm(sigmas_m, 0.95)},
          {"worst", worst_json(report)},
          {"poor", poor},
          {"recorded_s", rounded(recorded_s, 3)},
          {"processing_s", rounded(processing_s, 3)},
          {"times_real_time",
           recorded_s > 0.0 ? rounded(processing_s / recorded_s, 3) : 0.0}};
}

}  // namespace

double rounded(double value, int decimals) {
  MAREY_ASSERT(std::isfinite(value));
  const double scale = std::pow(10.0, decimals);
  // Adding zero changes minus zero to zero.
  return std::round(value * scale) / scale + 0.0;
}

Json report_json(const Report& report) {
  Json trials = Json::array();
  for (const ReportTrial& trial : report.trials) trials.push_back(trial_json(trial));
  Json timings = Json::array();
  for (const ReportTiming& timing : report.timings) {
    timings.push_back({{"stage", timing.stage}, {"seconds", rounded(timing.seconds, 3)}});
  }
  return {{"session", report.session},
          {"marey_version", report.version},
          {"summary", summary_json(report)},
          {"warnings", messages(report.findings, Severity::kFair)},
          {"trials", trials},
          {"calibration", calibration_json(report)},
          {"subject", subject_json(report)},
          {"timings", timings}};
}

std::string report_json_text(const Report& report) {
  // Names come from files and may have any bytes. Bytes that are not UTF-8 become U+FFFD.
  return report_json(report).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace marey::app
