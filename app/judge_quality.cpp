// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/judge_quality.h"

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "app/judge_motion.h"

namespace marey::app {
namespace {

// Webcams with a person in front of them end at 0.5 to 2 px.
constexpr double kPoorCalibrationPx = 3.0;
constexpr double kPoorSubjectPx = 5.0;
constexpr double kPoorTrialPx = 8.0;
constexpr double kPoorMedianPx = 3.0;
constexpr double kPoorCameraMedianPx = 5.0;
constexpr double kPoorTagMedianPx = 5.0;
constexpr int kFewestCorners = 80;  // 20 pictures.
constexpr double kLeastSolved = 0.9;

std::string text(const char* pattern, double a, double b = 0.0) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, a, b);
  return buffer.data();
}

Error poor(std::string where, std::string cause, std::string next) {
  return {Errc::kQuality, std::move(where), std::move(cause), std::move(next)};
}

/// Reports the worst tag among those that are often seen: a trial's averages hide one tag
/// among thirty.
void judge_tags(const ReportTrial& trial, std::vector<Error>& found) {
  const ReportTag* worst = nullptr;
  for (const ReportTag& tag : trial.tags) {
    if (!tag.median_px || tag.corners < kFewestCorners) continue;
    if (!worst || *tag.median_px > *worst->median_px) worst = &tag;
  }
  if (!worst || *worst->median_px < kPoorTagMedianPx) return;
  found.push_back(poor(
      "trial " + trial.name + ", tag " + std::to_string(worst->id),
      text("it is seen %.0f px away from its place on segment ", *worst->median_px) +
          worst->segment + " (median; good: under 1)",
      "check that it did not shift after the range of motion, and that "
      "no other person wears a tag with this number; then record again, or remove it "
      "from session.toml"));
}

void judge_trial(const ReportTrial& trial, std::vector<Error>& found) {
  const std::string where = "trial " + trial.name;
  if (trial.frames_solved < kLeastSolved * trial.frames) {
    found.push_back(poor(where,
                         text("only %.0f of %.0f frames could be solved",
                              trial.frames_solved,
                              trial.frames),
                         "look in report.html which tags are seen when"));
  }
  // One camera that is wrong is named; what it does to the others is not told again.
  bool told = false;
  for (const ReportTrialCamera& camera : trial.cameras) {
    if (camera.corners == 0 || camera.median_px < kPoorCameraMedianPx) continue;
    told = true;
    found.push_back(poor(where + ", camera " + camera.name,
                         text("the motion is %.0f px away from what it saw (median; "
                              "good: under 1)",
                              camera.median_px),
                         "check that this is its video of this trial, that its frames "
                         "are evenly spaced, and that it was not moved"));
  }
  if (told) return;
  if (trial.rms_px < kPoorTrialPx && trial.median_px < kPoorMedianPx) {
    judge_tags(trial, found);
    return;
  }
  found.push_back(poor(where,
                       text("the motion is %.1f px away from what the cameras saw "
                            "(median %.1f; good: under 2)",
                            trial.rms_px,
                            trial.median_px),
                       "check that this is the same person with the same tags, and look "
                       "at the pictures in report.html"));
}

}  // namespace

std::vector<Error> judge_quality(const Report& report) {
  std::vector<Error> found;
  if (!report.cameras_are_judged && report.calibration_rms_px > kPoorCalibrationPx) {
    found.push_back(poor("calibration.toml",
                         text("the cameras are %.1f px away from what they saw when they "
                              "were calibrated (good: under 0.5)",
                              report.calibration_rms_px),
                         "record the calibration again, with a flat board or a stiff "
                         "wand, and short exposure"));
  }
  if (report.subject_rms_px > kPoorSubjectPx) {
    found.push_back(poor("subject.toml",
                         text("the subject is %.1f px away from what the cameras saw "
                              "(good: under 1)",
                              report.subject_rms_px),
                         "check that every id is on the segment that session.toml says, "
                         "that tags are glued firmly, and that both trials show the same "
                         "person"));
  }
  for (const ReportTrial& trial : report.trials) {
    judge_trial(trial, found);
    for (Error& error : judge_motion(trial)) found.push_back(std::move(error));
  }
  return found;
}

}  // namespace marey::app
