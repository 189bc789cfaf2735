// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/session_source.h"

#include <algorithm>
#include <string>
#include <utility>

#include "app/process/pipeline.h"
#include "app/shell/console.h"
#include "recordings/base/temporary_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// Returns the name of the trial that a finding is about; empty: the whole run.
std::string trial_of(const Finding& finding, const Report& report) {
  for (const ReportTrial& trial : report.trials) {
    const std::string place = "trial " + trial.name;
    if (!finding.where.starts_with(place)) continue;
    const bool is_whole = finding.where.size() == place.size();
    if (is_whole || finding.where[place.size()] == ',' ||
        finding.where[place.size()] == ':') {
      return trial.name;
    }
  }
  return {};
}

SourceMotion motion_of_trial(const std::string& trial,
                             const EstimatedMotion& estimate,
                             const Report& report) {
  SourceMotion out;
  out.motion = estimate.motion;
  out.uncertainty = estimate.uncertainty;
  out.body = trial;
  out.rates.file_hz = out.motion.rate.hz;
  if (report.subject) out.subject = report.subject->name;
  const auto found = std::ranges::find(report.trials, trial, &ReportTrial::name);
  if (found != report.trials.end()) {
    const double share = found->frames > 0
                             ? static_cast<double>(found->frames_solved) / found->frames
                             : 0.0;
    out.figures.push_back({"residual_px", found->rms_px, std::nullopt, "", std::nullopt});
    out.figures.push_back({"solved_share", share, std::nullopt, "", std::nullopt});
  }
  int poor = 0;
  for (const Finding& finding : report.findings) {
    const std::string about = trial_of(finding, report);
    if (!about.empty() && about != trial) continue;
    out.remarks.push_back(finding.message());
    if (finding.severity == Severity::kPoor) ++poor;
  }
  if (poor > 0) {
    const int last = static_cast<int>(out.motion.poses.size()) - 1;
    out.problems.push_back({{0, last}, "fit", "", static_cast<double>(poor)});
  }
  return out;
}

}  // namespace

Result<std::vector<SourceMotion>> read_session_source(const fs::path& folder,
                                                      const fs::path& scratch) {
  const recordings::TemporaryFolder results(scratch);
  if (results.path().empty()) {
    return Error{Errc::kDevice,
                 scratch.string(),
                 "no temporary folder can be created for the results of the session",
                 "free space, or check the permissions of the folder"};
  }
  Console console(ProgressStyle::kKept);
  PipelineOptions options;
  options.session = folder;
  options.out = results.path();
  auto pipeline = Pipeline::open(Stage::kProcess, options, console);
  if (!pipeline) return pipeline.error();
  if (const Status ok = run_to(Stage::kProcess, *pipeline); !ok) return ok.error();
  if (const Status ok = pipeline->assess(); !ok) return ok.error();
  std::vector<SourceMotion> all;
  for (const auto& [trial, estimate] : pipeline->motions()) {
    all.push_back(motion_of_trial(trial, *estimate, pipeline->report()));
  }
  std::vector<std::string> notes = console.kept_warnings();
  for (SourceMotion& motion : all) {
    motion.remarks.insert(motion.remarks.begin(), notes.begin(), notes.end());
  }
  return all;
}

}  // namespace marey::app
