// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/fit_run.h"

#include <algorithm>
#include <span>
#include <utility>

#include "app/markers/assess_fit.h"
#include "app/markers/label_checks.h"
#include "app/markers/trial_checks.h"
#include "core/base/stopwatch.h"
#include "reconstruct/markers/estimate_stature.h"
#include "recordings/markers/marker_map.h"
#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

std::string all_inputs(const FitArguments& args) {
  const std::string first = args.in.front().string();
  const std::size_t others = args.in.size() - 1;
  if (others == 0) return first;
  return first + " and " + std::to_string(others) +
         (others == 1 ? " other file" : " other files");
}

/// Returns the subject's name in the recording: "Bob" for "Bob:LASI".
std::string name_of_subject(const FitArguments& args,
                            std::span<const MarkerTrial> trials) {
  if (!args.name.empty()) return args.name;
  std::string name = trials.front().prefix;
  while (!name.empty() && name.back() == ':') name.pop_back();
  return name.empty() ? "subject" : name;
}

/// Takes the subject of an earlier fit.
Status take_subject(const FitArguments& args, FitRun& run) {
  auto body = recordings::read_subject(args.subject);
  if (!body) return body.error();
  if (body->markers.empty()) {
    return bad_input(args.subject.string(),
                     "the subject has no markers",
                     "give the subject.toml of an earlier `marey fit`");
  }
  run.body = std::move(*body);
  return Done{};
}

/// Returns the subject's data given by the user.
reconstruct::MarkerSubject given_subject(const FitArguments& args, const FitRun& run) {
  reconstruct::MarkerSubject subject;
  subject.name = name_of_subject(args, run.trials);
  subject.stature_m = args.stature_m;
  subject.mass_kg = args.mass_kg;
  return subject;
}

Status find_subject(const FitArguments& args,
                    std::span<const MarkerTracks> checked,
                    const Progress& progress,
                    FitRun& run) {
  const auto size = reconstruct::estimate_stature(checked, used_labels(run.labels));
  if (size) {
    if (const Status ok = check_size(run.trials, size->stature_m); !ok) return ok;
  }
  auto fit = fit_subject_to(given_subject(args, run), checked, run.labels, progress);
  if (!fit) return fit.error();
  run.body = fit->fit.body;
  run.subject = std::move(*fit);
  return Done{};
}

/// Returns the cause of a failed fit: exchanged sides or a wrong axis, else `error`.
Error cause_of(const FitRun& run, Error error) {
  const std::vector<Finding> causes = assess_sides_and_axes(run.trials, run.geometry);
  if (causes.empty()) return error;
  return bad_input(causes.front().where, causes.front().cause, causes.front().next);
}

}  // namespace

Result<std::optional<MarkerMap>> read_fit_givens(const FitArguments& args, FitRun& run) {
  std::optional<MarkerMap> map;
  if (!args.map.empty()) {
    auto read = recordings::read_marker_map(args.map);
    if (!read) return read.error();
    map = std::move(*read);
  }
  if (!args.subject.empty()) {
    if (const Status ok = take_subject(args, run); !ok) return ok.error();
  }
  return map;
}

Status solve_fit(const FitArguments& args,
                 const std::optional<MarkerMap>& map,
                 Console& console,
                 FitRun& run) {
  const auto somewhere = [&](Error error) {
    if (error.where.empty()) error.where = all_inputs(args);
    return error;
  };
  const Stopwatch repairing;
  std::vector<MarkerTracks> checked = repair_trials(run.trials, console.stage("repair"));
  run.times.repair_s = repairing.seconds();
  const Stopwatch fitting;
  std::vector<std::string> prefixes;
  for (const MarkerTrial& trial : run.trials) prefixes.push_back(trial.prefix);
  auto labels = name_labels(checked, prefixes, map);
  if (labels) {
    run.labels = std::move(*labels);
  } else if (args.subject.empty()) {
    return somewhere(labels.error());
  }
  run.geometry = reconstruct::compare_trials(checked, used_labels(run.labels));
  if (const Status ok = check_units(run.trials, run.geometry); !ok) return ok;
  if (args.subject.empty()) {
    const Status ok = find_subject(args, checked, console.stage("fit"), run);
    if (!ok) return cause_of(run, somewhere(ok.error()));
  }
  checked.clear();
  run.times.fit_s = fitting.seconds();
  const Stopwatch solving;
  solve_trials(run.body, run.trials, console.stage("solve"));
  run.times.solve_s = solving.seconds();
  const bool is_any_solved = std::any_of(
      run.trials.begin(), run.trials.end(), [](const auto& t) { return t.solved; });
  if (is_any_solved) return Done{};
  return somewhere(bad_input("",
                             "no frame shows six of the subject's markers",
                             "see the labels in `marey inspect FILE`"));
}

std::vector<Finding> assess_fit_run(const FitArguments& args, FitRun& run) {
  std::vector<Finding> failures = assess_sides_and_axes(run.trials, run.geometry);
  if (!failures.empty()) return failures;
  const LabelledFit* subject = run.subject ? &*run.subject : nullptr;
  run.checks = find_label_faults(
      run.body, given_subject(args, run), subject, run.labels, run.trials);
  failures = assess_fit(run.trials, subject, run.body, args.stature_m);
  if (subject != nullptr && subject->fit.measured_stature) {
    auto small =
        assess_small_stature(run.trials, *subject->fit.measured_stature, args.stature_m);
    if (small) failures.push_back(std::move(*small));
  }
  for (Finding& failure : assess_labels(run.checks, run.trials)) {
    failures.push_back(std::move(failure));
  }
  return failures;
}

}  // namespace marey::app
