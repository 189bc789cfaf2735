// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Last stages of the pipeline: motions of other bodies, and the report.
#include <algorithm>
#include <iterator>
#include <utility>

#include <glm/trigonometric.hpp>

#include "app/check/assess_floor_height.h"
#include "app/check/assess_results.h"
#include "app/check/assess_trial.h"
#include "app/motion/retarget_files.h"
#include "app/process/pipeline.h"
#include "app/process/report_trial.h"
#include "core/base/stopwatch.h"
#include "reconstruct/tags/solve_motion.h"
#include "reconstruct/tags/trial_residuals.h"
#include "recordings/base/atomic_file.h"

namespace marey::app {

namespace {

/// Returns 12 frames from the middle of a trial.
std::vector<CameraDetections> middle_frames(std::vector<CameraDetections> detections) {
  constexpr std::size_t kFrames = 12;
  for (CameraDetections& camera : detections) {
    if (camera.frames.size() <= kFrames) continue;
    const auto first = static_cast<std::ptrdiff_t>((camera.frames.size() - kFrames) / 2);
    const auto end = first + static_cast<std::ptrdiff_t>(kFrames);
    camera.frames = {camera.frames.begin() + first, camera.frames.begin() + end};
    camera.in_recording.clear();
  }
  return detections;
}

}  // namespace

Status Pipeline::add_floor_findings() {
  const recordings::Trial* trial = session_.find(recordings::TrialKind::kStatic);
  if (!trial) return Done{};
  const auto detections = unshrunk_detections_of(*trial);
  if (!detections) return detections.error();
  const auto standing =
      reconstruct::solve_motion(*body_, cameras_, middle_frames(*detections));
  if (!standing) return Done{};  // This check is optional: all motions are solved.
  const auto height_m = sole_height_m(standing->estimate, body_->stature_m);
  if (!height_m) return Done{};
  std::vector<SoleHeight> motions;
  for (const SolvedMotion& motion : motions_) {
    const auto lowest_m = sole_height_m(motion.solved.estimate, body_->stature_m);
    if (lowest_m) motions.push_back({motion.trial->name, *lowest_m});
  }
  auto finding = assess_floor_height(session_, {trial->name, *height_m}, motions);
  if (finding) add(std::move(*finding));
  return Done{};
}

Status Pipeline::retarget() {
  const Stopwatch watch;
  for (SolvedMotion& motion : motions_) {
    for (const auto& avatar : options_.avatars) {
      auto body = retarget_one(motion, avatar);
      if (!body) return body.error();
      motion.avatars.push_back(std::move(*body));
    }
  }
  if (!options_.avatars.empty()) time_stage("avatars", watch.seconds());
  return Done{};
}

Result<ReportBody> Pipeline::retarget_one(SolvedMotion& motion,
                                          const std::filesystem::path& avatar) {
  const std::string name = avatar.stem().string();
  const std::filesystem::path folder = motion.trial->name;
  const auto written = retarget_to_files(
      motion.solved.estimate.motion, avatar, options_.out / folder / name);
  if (!written) return written.error();
  ReportBody body;
  body.name = name;
  body.motion = written->retargeted.motion;
  body.slide_before_cm_per_s = written->retargeted.report.before.mean_slide_cm_per_s;
  body.slide_after_cm_per_s = written->retargeted.report.after.mean_slide_cm_per_s;
  const AvatarVerdict& verdict = written->verdict;
  body.penetration_mm = verdict.penetration_mm(written->retargeted.report);
  if (verdict.skin && verdict.skin->frame) {
    if (verdict.skin->part) body.penetration_part = retarget::name(*verdict.skin->part);
    body.penetration_frame = verdict.skin->frame;
  }
  body.source_depth_mm = 1e3 * verdict.source_depth_m;
  body.legs_deg = glm::degrees(verdict.posture.legs.median_rad);
  body.arms_deg = glm::degrees(verdict.posture.arms.median_rad);
  body.trunk_deg = glm::degrees(verdict.posture.trunk.median_rad);
  for (Finding problem : verdict.problems) {
    problem.where = "trial " + folder.string() + ", " + problem.where;
    body.problems.push_back(problem);
    add_of_trial(motion.trial->name, std::move(problem));
  }
  for (const auto& file : written->files) {
    body.files.push_back((folder / file.filename()).string());
  }
  return body;
}

Status Pipeline::add_trial_findings() {
  std::vector<Finding> found = assess_rig_and_subject(report_);
  for (const ReportTrial& trial : report_.trials) {
    std::vector<Finding> poor = assess_trial_results(trial);
    if (!poor.empty()) poor_trials_.insert(trial.name);
    std::move(poor.begin(), poor.end(), std::back_inserter(found));
  }
  for (const SolvedMotion& motion : motions_) {
    // Trials in poor_trials_ already have a failure for large residuals or wrong offsets.
    if (poor_trials_.contains(motion.trial->name)) continue;
    const auto detections = unshrunk_detections_of(*motion.trial);
    if (!detections) return detections.error();
    const auto residuals =
        reconstruct::trial_residuals(*body_, cameras_, *detections, motion.solved);
    if (auto poor = assess_trial(session_, *motion.trial, residuals)) {
      found.push_back(std::move(*poor));
    }
  }
  for (Finding& poor : found) add(std::move(poor));
  return Done{};
}

Status Pipeline::assess() {
  report_.trials.clear();
  for (const SolvedMotion& motion : motions_) {
    const auto detections = unshrunk_detections_of(*motion.trial);
    if (!detections) return detections.error();
    auto trial =
        report_trial(*motion.trial, cameras_, session_.tags, *detections, motion.solved);
    if (!trial) return trial.error();
    trial->bodies.insert(
        trial->bodies.end(), motion.avatars.begin(), motion.avatars.end());
    report_.trials.push_back(std::move(*trial));
  }
  report_.recorded_s = 0.0;
  for (const auto& [name, cameras] : detections_) {
    double max_s = 0.0;
    for (const CameraDetections& camera : cameras) {
      max_s = std::max(max_s, static_cast<double>(camera.frames.size()) / camera.rate.hz);
    }
    report_.recorded_s += max_s;
  }
  return add_trial_findings();
}

std::vector<std::pair<std::string, const EstimatedMotion*>> Pipeline::motions() const {
  std::vector<std::pair<std::string, const EstimatedMotion*>> all;
  for (const SolvedMotion& motion : motions_) {
    all.emplace_back(motion.trial->name, &motion.solved.estimate);
  }
  return all;
}

Status Pipeline::write_report() {
  const Stopwatch watch;
  if (const Status ok = assess(); !ok) return ok;
  std::error_code ignored;
  report_.has_calibration_page =
      std::filesystem::exists(options_.out / "calibration.html", ignored);
  time_stage("report", watch.seconds());
  if (const Status ok =
          recordings::write_file(options_.out / "report.json", report_json_text(report_));
      !ok) {
    return ok;
  }
  return recordings::write_file(options_.out / "report.html", report_html(report_));
}

Status run_to(Stage stage, Pipeline& pipeline) {
  if (const Status ok = pipeline.track(); !ok) return ok;
  if (stage == Stage::kTrack) return Done{};
  if (stage != Stage::kSolve) {
    if (const Status ok = pipeline.calibrate(); !ok) return ok;
    if (stage == Stage::kCalibrate) return Done{};
  }
  if (const Status ok = pipeline.fit(); !ok) return ok;
  return pipeline.solve();
}

}  // namespace marey::app
