// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/pipeline.h"

#include <algorithm>
#include <set>
#include <utility>

#include "app/check/assess_body.h"
#include "app/check/assess_moved_camera.h"
#include "app/check/assess_offsets.h"
#include "app/check/check_detections.h"
#include "app/check/check_ids.h"
#include "app/check/check_session.h"
#include "app/check/check_trial_kinds.h"
#include "app/check/check_videos.h"
#include "app/check/find_turned_video.h"
#include "app/check/mean_centre_sigma.h"
#include "app/motion/retarget_files.h"
#include "app/motion/write_motion.h"
#include "app/process/find_tags.h"
#include "app/shell/findings.h"
#include "app/shell/version.h"
#include "core/base/assert.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "reconstruct/clusters/check_views.h"
#include "reconstruct/subject/fit_subject.h"
#include "recordings/base/atomic_file.h"
#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

using recordings::Trial;
using recordings::TrialKind;

Error missing_trial(const recordings::Session& session, TrialKind kind) {
  return bad_input(
      session.file.string(),
      "there is no trial of kind \"" + std::string(recordings::name(kind)) + "\"",
      "record one and add it as a [[trial]]");
}

/// Removes motions that are not recorded yet, with a warning: other trials can be
/// processed.
void leave_out_unrecorded(recordings::Session& session, Console& console) {
  std::erase_if(session.trials, [&](const Trial& trial) {
    const bool left_out = trial.is_recorded && trial.kind == TrialKind::kMotion &&
                          !recordings::has_recording(trial);
    if (left_out) console.warn("trial " + trial.name + " is not recorded yet");
    return left_out;
  });
}

/// Removes the trials that a calibration does not need, as cameras are calibrated before
/// the others are recorded. With a floor trial, the static trial may be missing too.
void keep_for_calibration(recordings::Session& session, Console& console) {
  const bool has_floor = session.find(TrialKind::kFloor) != nullptr;
  std::erase_if(session.trials, [&](const Trial& trial) {
    if (trial.kind == TrialKind::kCalibration || trial.kind == TrialKind::kFloor) {
      return false;
    }
    if (trial.kind != TrialKind::kStatic) return true;
    const bool is_left_out =
        has_floor && (trial.is_recorded ? !recordings::has_recording(trial)
                                        : !recordings::has_video(trial));
    if (is_left_out) {
      console.warn("trial " + trial.name +
                   " is not recorded yet: the floor is not checked against a standing "
                   "subject");
    }
    return is_left_out;
  });
}

/// Checks what can be checked from session.toml alone.
Status check_before(Stage stage, const recordings::Session& session) {
  if (stage == Stage::kTrack) return Done{};
  if (stage != Stage::kSolve) {
    if (const Status ok = check_calibrated_cameras(session); !ok) return ok;
  }
  return stage == Stage::kCalibrate ? Status(Done{}) : check_worn_segments(session);
}

/// Returns the kinds of trials that a stage needs, together with the stages before it.
std::vector<TrialKind> kinds_for(Stage stage) {
  switch (stage) {
    case Stage::kTrack:
      return {};
    case Stage::kCalibrate:
      return {TrialKind::kCalibration};
    case Stage::kSolve:
    case Stage::kProcess:
      return {TrialKind::kCalibration,
              TrialKind::kStatic,
              TrialKind::kRangeOfMotion,
              TrialKind::kMotion};
  }
  return {};
}

}  // namespace

Pipeline::Pipeline(recordings::Session session, PipelineOptions options, Console& console)
    : session_(std::move(session)), options_(std::move(options)), console_(&console) {
  report_.session = session_.name;
  report_.version = kVersion;
}

Result<Pipeline> Pipeline::open(Stage stage,
                                const PipelineOptions& options,
                                Console& console) {
  auto session = recordings::read_session(options.session, {options.media});
  if (!session) return session.error();
  leave_out_unrecorded(*session, console);
  if (stage == Stage::kCalibrate) keep_for_calibration(*session, console);
  for (const auto& [word, lens] : recordings::kLensWords) {
    if (options.lens == word) session->calibration.lens = lens;
  }
  for (const TrialKind kind : kinds_for(stage)) {
    if (!session->find(kind)) return missing_trial(*session, kind);
  }
  if (const Status ok = check_before(stage, *session); !ok) return ok.error();
  if (const Status ok = recordings::check_files(*session); !ok) return ok.error();
  std::vector<Finding> findings;
  if (auto sides = assess_sides(*session)) findings.push_back(std::move(*sides));
  const Status opened = check_videos(*session, findings);
  print_warnings(console, findings);
  if (!opened) return opened.error();
  std::set<std::string> names{"motion"};
  for (const auto& avatar : options.avatars) {
    if (!names.insert(avatar.stem().string()).second) {
      return bad_input(
          avatar.string(),
          "two results would have the name \"" + avatar.stem().string() + "\"",
          "rename the file of the avatar: results are named after it");
    }
    if (const Status ok = check_avatar(avatar); !ok) return ok.error();
  }
  return Pipeline(std::move(*session), options, console);
}

std::vector<const Trial*> Pipeline::motion_trials() const {
  std::vector<const Trial*> trials;
  for (const Trial& trial : session_.trials) {
    if (trial.kind == TrialKind::kMotion) trials.push_back(&trial);
  }
  return trials;
}

Error Pipeline::in_session(Error error) const {
  const std::string file = session_.file.string();
  if (error.where.empty()) {
    error.where = file;
  } else if (error.where.front() == '[') {
    error.where = file + ": " + error.where;
  }
  return error;
}

void Pipeline::add(Finding finding) {
  report_.findings.push_back(std::move(finding));
}

void Pipeline::add_of_trial(const std::string& trial, Finding finding) {
  if (finding.severity == Severity::kPoor) poor_trials_.insert(trial);
  add(std::move(finding));
}

void Pipeline::time_stage(const std::string& name, double seconds) {
  report_.timings.push_back({name, seconds});
}

Status Pipeline::track() {
  const Stopwatch watch;
  std::set<std::string> lost;
  for (const Trial& trial : session_.trials) {
    const Status ok = track_trial(trial);
    if (ok) continue;
    if (trial.kind != TrialKind::kMotion) return ok;
    // Other motions do not depend on this one.
    add(tolerated(Severity::kPoor, "trial", ok.error()));
    lost.insert(trial.name);
  }
  std::erase_if(session_.trials, [&](const Trial& t) { return lost.contains(t.name); });
  if (!lost.empty() && motion_trials().empty()) {
    // The last of these findings ends the work.
    std::vector<Finding>& all = report_.findings;
    const auto last = std::find_if(all.rbegin(), all.rend(), [](const Finding& finding) {
      return finding.severity == Severity::kPoor;
    });
    MAREY_ASSERT(last != all.rend());
    const Error error = last->error();
    all.erase(std::next(last).base());
    return error;
  }
  time_stage("tags", watch.seconds());
  return check_ids(session_, detections_, report_.findings);
}

Status Pipeline::track_trial(const Trial& trial) {
  if (detections_.contains(trial.name)) return Done{};
  std::vector<Finding> findings;
  auto found = find_tags(session_, trial, options_.out, *console_, findings);
  if (!found) return found.error();
  std::stable_sort(
      findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
        return a.severity < b.severity;
      });
  for (Finding& finding : findings) add(std::move(finding));
  for (const auto& [name, earlier] : detections_) {
    if (const Status ok = check_picture_sizes(earlier, *found); !ok) return ok;
  }
  detections_[trial.name] = std::move(*found);
  return Done{};
}

Result<std::vector<CameraDetections>> Pipeline::detections_of(const Trial& trial) {
  if (const Status ok = track_trial(trial); !ok) return ok.error();
  return detections_.at(trial.name);
}

Result<std::vector<CameraDetections>> Pipeline::unshrunk_detections_of(
    const Trial& trial) {
  auto detections = detections_of(trial);
  if (!detections) return detections.error();
  correct_shrinkage(cameras_, *detections);
  return detections;
}

Status Pipeline::check_trials() {
  double max_centre_sigma_m = 0.0;
  for (const ReportCamera& camera : report_.cameras) {
    max_centre_sigma_m = std::max(max_centre_sigma_m, camera.quality.centre_sigma_m);
  }
  for (const Trial& trial : session_.trials) {
    if (trial.kind == TrialKind::kCalibration || trial.kind == TrialKind::kFloor)
      continue;
    const auto detections = unshrunk_detections_of(trial);
    if (!detections) return detections.error();
    const Status ok = reconstruct::check_views(cameras_, *detections, session_.tags);
    if (!ok) {
      const auto turned = find_turned_video(cameras_, *detections, session_.tags);
      return in_session(turned ? *turned : ok.error());
    }
    if (auto wrong = assess_trial_offsets(
            session_, trial, cameras_, *detections, max_centre_sigma_m)) {
      add_of_trial(trial.name, std::move(*wrong));
    }
    if (auto moved =
            assess_moved_camera(trial.name, cameras_, *detections, session_.tags)) {
      add_of_trial(trial.name, std::move(*moved));
    }
  }
  return Done{};
}

Status Pipeline::fit() {
  if (const Status ok = need_cameras(); !ok) return ok;
  const Trial* standing_trial = session_.find(TrialKind::kStatic);
  const Trial* moving_trial = session_.find(TrialKind::kRangeOfMotion);
  MAREY_ASSERT(standing_trial && moving_trial);
  const auto standing = unshrunk_detections_of(*standing_trial);
  if (!standing) return standing.error();
  const auto moving = unshrunk_detections_of(*moving_trial);
  if (!moving) return moving.error();
  // All trials are checked before the long computation, so exchanged videos are reported
  // early.
  if (const Status ok = check_trials(); !ok) return ok;
  if (auto exercise = assess_range_of_motion(session_, detections_)) {
    add(std::move(*exercise));
  }
  const Stopwatch watch;
  const reconstruct::SubjectPrior prior{session_.subject.name,
                                        session_.subject.stature_m,
                                        session_.subject.mass_kg,
                                        session_.tags};
  const auto fit = reconstruct::fit_subject(
      prior, cameras_, *standing, *moving, console_->stage("subject"));
  if (!fit) return in_session(fit.error());
  body_ = fit->body;
  report_.subject_rms_px = fit->rms_px;
  report_.limb_ratio = fit->limb_ratio;
  for (Finding finding : fit->findings) {
    finding.where = in_session(finding.error()).where;
    add(std::move(finding));
  }
  for (Finding& finding : assess_body(*body_)) {
    finding.where = session_.file.string();
    add(std::move(finding));
  }
  for (const TagId id : fit->unplaced) {
    report_.unplaced_tags.push_back(number(id));
    add(fair_finding("unplaced",
                     "",
                     "tag " + std::to_string(number(id)) +
                         " is not used: it was never seen well enough to locate it on "
                         "the body"));
  }
  time_stage("subject", watch.seconds());
  return recordings::write_subject(options_.out / "subject.toml", *body_);
}

Status Pipeline::need_body() {
  if (const Status ok = need_cameras(); !ok) return ok;
  // The file is read even if this run wrote it, so the stage gets the same numbers in
  // both cases.
  auto body = recordings::read_subject(options_.out / "subject.toml");
  if (!body) return body.error();
  body_ = std::move(*body);
  report_.subject = *body_;
  return Done{};
}

Result<reconstruct::SolvedTrial> Pipeline::solve_trial(const Trial& trial,
                                                       const Progress& progress) {
  const auto detections = unshrunk_detections_of(trial);
  if (!detections) return detections.error();
  // A camera without a video in this trial keeps its index and has no frames.
  reconstruct::SolveMotionOptions options;
  std::vector<CameraQuality> quality;
  for (const ReportCamera& camera : report_.cameras) quality.push_back(camera.quality);
  options.camera_sigma_m = mean_centre_sigma_m(quality);
  auto solved =
      reconstruct::solve_motion(*body_, cameras_, *detections, options, progress);
  if (!solved) return in_session(solved.error());
  return solved;
}

Status Pipeline::solve() {
  if (const Status ok = need_body(); !ok) return ok;
  const std::vector<const Trial*> trials = motion_trials();
  for (const Trial* trial : trials) {
    if (const Status ok = track_trial(*trial); !ok) return ok;
  }
  const Stopwatch watch;
  std::vector<std::optional<Result<reconstruct::SolvedTrial>>> results(trials.size());
  in_parallel(trials.size(), 0, [&](std::size_t i) {
    results[i] = solve_trial(*trials[i], console_->stage("motion of " + trials[i]->name));
  });
  time_stage("motion", watch.seconds());
  const Stopwatch writing;
  motions_.clear();
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!*results[i]) return results[i]->error();
    motions_.push_back({trials[i], std::move(**results[i]), {}});
    const std::filesystem::path folder = options_.out / trials[i]->name;
    const reconstruct::SolvedTrial& solved = motions_.back().solved;
    const Status written = write_motion(folder, solved.estimate, body_->proportions);
    if (!written) return written;
    const Status tags = write_tag_markers(folder, *body_, solved);
    if (!tags) return tags;
  }
  time_stage("files", writing.seconds());
  return add_floor_findings();
}

}  // namespace marey::app
