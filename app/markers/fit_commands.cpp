// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/fit_commands.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/markers/assess_fit.h"
#include "app/markers/fit_json.h"
#include "app/markers/fit_results.h"
#include "app/markers/fit_words.h"
#include "app/markers/label_checks.h"
#include "app/markers/marker_report.h"
#include "app/markers/trial_checks.h"
#include "app/motion/raw_body.h"
#include "app/shell/findings.h"
#include "app/shell/option_checks.h"
#include "core/base/stopwatch.h"
#include "reconstruct/markers/estimate_stature.h"
#include "recordings/base/atomic_file.h"
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

/// Reads all input, so that its errors are reported before the work begins.
Status read_all(const FitArguments& args,
                Console& console,
                FitRun& run,
                std::optional<MarkerMap>& map) {
  const Stopwatch watch;
  if (const Status ok = check_out_folder(args.out); !ok) return ok;
  if (const Status ok = check_avatars(args.avatars); !ok) return ok;
  if (!args.map.empty()) {
    auto read = recordings::read_marker_map(args.map);
    if (!read) return read.error();
    map = std::move(*read);
  }
  if (!args.subject.empty()) {
    if (const Status ok = take_subject(args, run); !ok) return ok;
  }
  recordings::MarkerReadOptions options;
  if (!args.up.empty()) options.up = recordings::axis_of(args.up);
  if (!args.unit.empty()) options.unit = args.unit;
  auto trials = read_trials(args.in, options, args.out, console);
  if (!trials) return trials.error();
  run.trials = std::move(*trials);
  run.times.read_s = watch.seconds();
  return Done{};
}

/// Returns the cause of a failed fit: exchanged sides or a wrong axis, else `error`.
Error cause_of(const FitRun& run, Error error) {
  const std::vector<Finding> causes = assess_sides_and_axes(run.trials, run.geometry);
  if (causes.empty()) return error;
  return bad_input(causes.front().where, causes.front().cause, causes.front().next);
}

/// Returns the poor findings on the result. Exchanged sides and wrong axes are the cause
/// of others and are returned alone.
std::vector<Finding> assess_all(const FitArguments& args, FitRun& run) {
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

Status solve_all(const FitArguments& args,
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

Status write_all(const FitArguments& args, FitRun& run, std::string& json) {
  const Stopwatch watch;
  if (const Status ok = recordings::write_subject(args.out / "subject.toml", run.body);
      !ok) {
    return ok;
  }
  for (MarkerTrial& trial : run.trials) {
    const Status ok = write_trial(run.body, args.avatars, args.out / trial.name, trial);
    if (!ok) return ok;
  }
  run.times.write_s = watch.seconds();
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  json = fit_json(run).dump(1, ' ', false, kReplace) + "\n";
  const Status ok = recordings::write_file(args.out / "fit.html", fit_page(run));
  if (!ok) return ok;
  return recordings::write_file(args.out / "fit.json", json);
}

}  // namespace

Exit run_fit(const FitArguments& args, Console& console) {
  FitRun run;
  std::optional<MarkerMap> map;
  if (const Status ok = read_all(args, console, run, map); !ok) {
    return console.fail(ok.error());
  }
  if (const Status ok = solve_all(args, map, console, run); !ok) {
    return console.fail(ok.error());
  }
  std::vector<Finding> failures = assess_all(args, run);
  run.findings = assess_run(run);
  std::move(failures.begin(), failures.end(), std::back_inserter(run.findings));
  std::string json;
  if (const Status ok = write_all(args, run, json); !ok) return console.fail(ok.error());
  for (const std::string& line : subject_words(run)) console.say(line);
  print_warnings(console, run.findings);
  for (const MarkerTrial& trial : run.trials) console.say(trial_words(trial));
  console.say("results: " + args.out.string());
  if (args.json) std::fputs(json.c_str(), stdout);
  // All results are written, but the exit code must still report a fault.
  return print_failures(console, run.findings);
}

void add_fit_command(CLI::App& app,
                     FitArguments& args,
                     std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand(
      "fit", "Fit a subject and its motion to labelled markers (C3D, TRC)");
  command->add_option("INPUT", args.in, "Trials of one subject, .c3d or .trc")
      ->required();
  command->add_option("-o,--out", args.out, "Folder for the results")->required();
  CLI::Option* map = command->add_option(
      "--markers", args.map, "Meaning of labels with unknown names (MAP.toml)");
  CLI::Option* subject = command->add_option(
      "--subject", args.subject, "subject.toml of an earlier fit, instead of fitting");
  CLI::Option* person = command->add_option("--name", args.name, "The subject's name");
  CLI::Option* stature =
      command->add_option("--stature", args.stature_m, "Stature of the subject [m]")
          ->check(between(0.3, 3.0));
  CLI::Option* mass =
      command->add_option("--mass", args.mass_kg, "Mass of the subject [kg]")
          ->check(between(1.0, 500.0));
  for (CLI::Option* option : {map, person, stature, mass}) option->excludes(subject);
  command
      ->add_option(
          "-a,--avatar",
          args.avatars,
          "Body to retarget the motion to: " + body_extensions() + "; may be repeated")
      // One value per option: the next argument may be a trial.
      ->allow_extra_args(false);
  command->add_option("--up", args.up, "Up axis of the files; default as detected")
      ->check(one_of({"+X", "+Y", "+Z", "-X", "-Y", "-Z"}));
  command->add_option("--unit", args.unit, "Unit of the files; default as stated in them")
      ->check(one_of({"mm", "cm", "m", "in", "ft"}));
  command->add_flag("--json", args.json, "Print fit.json on standard output");
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_fit(args, console); }; });
}

}  // namespace marey::app
