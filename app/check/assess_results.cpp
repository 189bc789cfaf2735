// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_results.h"

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "app/check/assess_motion.h"

namespace marey::app {
namespace {

// Reprojection errors of webcams with a person in view are 0.5 to 2 px.
constexpr double kPoorCalibrationPx = 3.0;
constexpr double kPoorSubjectPx = 5.0;
constexpr double kPoorTrialPx = 8.0;
constexpr double kPoorMedianPx = 3.0;
constexpr double kPoorCameraMedianPx = 5.0;
constexpr double kPoorTagMedianPx = 5.0;
constexpr int kMinTagCorners = 80;  // 20 pictures.
constexpr double kMinSolved = 0.9;

std::string text(const char* pattern, double a, double b = 0.0) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, a, b);
  return buffer.data();
}

/// Reports the worst of the tags with enough corners: the averages of a trial hide one
/// wrong tag among thirty.
void assess_tags(const ReportTrial& trial, std::vector<Finding>& found) {
  const ReportTag* worst = nullptr;
  for (const ReportTag& tag : trial.tags) {
    if (!tag.median_px || tag.corners < kMinTagCorners) continue;
    if (!worst || *tag.median_px > *worst->median_px) worst = &tag;
  }
  if (!worst || *worst->median_px < kPoorTagMedianPx) return;
  found.push_back(poor_finding(
      "tag",
      "trial " + trial.name + ", tag " + std::to_string(worst->id),
      text("it is seen %.0f px away from its place on segment ", *worst->median_px) +
          worst->segment + " (median; good: under 1)",
      "check that it did not shift after the range of motion, and that "
      "no other person wears a tag with this number; then record again, or remove it "
      "from session.toml"));
}

void assess_residuals(const ReportTrial& trial, std::vector<Finding>& found) {
  const std::string where = "trial " + trial.name;
  if (trial.frames_solved < kMinSolved * trial.frames) {
    found.push_back(poor_finding("unsolved",
                                 where,
                                 text("only %.0f of %.0f frames could be solved",
                                      trial.frames_solved,
                                      trial.frames),
                                 "check in report.html when each tag is seen"));
  }
  // If one camera is wrong, it is reported alone: errors of the others are its
  // consequence.
  bool has_wrong_camera = false;
  for (const ReportTrialCamera& camera : trial.cameras) {
    if (camera.corners == 0 || camera.median_px < kPoorCameraMedianPx) continue;
    has_wrong_camera = true;
    found.push_back(
        poor_finding("camera",
                     where + ", camera " + camera.name,
                     text("the motion is %.0f px away from the detected tags (median; "
                          "good: under 1)",
                          camera.median_px),
                     "check that this is its video of this trial, that its frames "
                     "are evenly spaced, and that it was not moved"));
  }
  if (has_wrong_camera) return;
  if (trial.rms_px < kPoorTrialPx && trial.median_px < kPoorMedianPx) {
    assess_tags(trial, found);
    return;
  }
  found.push_back(
      poor_finding("trial",
                   where,
                   text("the motion is %.1f px away from the detected tags "
                        "(median %.1f; good: under 2)",
                        trial.rms_px,
                        trial.median_px),
                   "check that this is the same person with the same tags, and look "
                   "at the pictures in report.html"));
}

}  // namespace

std::vector<Finding> assess_rig_and_subject(const Report& report) {
  std::vector<Finding> found;
  if (!report.cameras_are_assessed && report.calibration_rms_px > kPoorCalibrationPx) {
    found.push_back(
        poor_finding("calibration",
                     "calibration.toml",
                     text("the reprojection error of the calibration is %.1f px "
                          "(good: under 0.5)",
                          report.calibration_rms_px),
                     "record the calibration again, with a flat board or a stiff "
                     "wand, and short exposure"));
  }
  if (report.subject_rms_px > kPoorSubjectPx) {
    found.push_back(
        poor_finding("subject",
                     "subject.toml",
                     text("the subject is %.1f px away from the detected tags "
                          "(good: under 1)",
                          report.subject_rms_px),
                     "check that every tag is on its segment in session.toml, that tags "
                     "are glued firmly, and that both trials show the same person"));
  }
  return found;
}

std::vector<Finding> assess_trial_results(const ReportTrial& trial) {
  std::vector<Finding> found;
  assess_residuals(trial, found);
  for (Finding& finding : assess_motion(trial)) found.push_back(std::move(finding));
  return found;
}

std::vector<Finding> assess_results(const Report& report) {
  std::vector<Finding> found = assess_rig_and_subject(report);
  for (const ReportTrial& trial : report.trials) {
    for (Finding& finding : assess_trial_results(trial)) {
      found.push_back(std::move(finding));
    }
  }
  return found;
}

}  // namespace marey::app
