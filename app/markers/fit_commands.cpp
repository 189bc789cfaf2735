// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/markers/fit_commands.h"

#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/markers/fit_results.h"
#include "app/markers/fit_words.h"
#include "app/markers/marker_report.h"
#include "app/motion/raw_body.h"
#include "app/shell/findings.h"
#include "app/shell/option_checks.h"
#include "core/base/stopwatch.h"
#include "recordings/base/atomic_file.h"
#include "recordings/session/subject_file.h"

namespace marey::app {
namespace {

/// Reads all input, so that its errors are reported before the work begins.
Status read_all(const FitArguments& args,
                Console& console,
                FitRun& run,
                std::optional<MarkerMap>& map) {
  const Stopwatch watch;
  if (const Status ok = check_out_folder(args.out); !ok) return ok;
  if (const Status ok = check_avatars(args.avatars); !ok) return ok;
  auto givens = read_fit_givens(args, run);
  if (!givens) return givens.error();
  map = *std::move(givens);
  recordings::MarkerReadOptions options;
  if (!args.up.empty()) options.up = recordings::axis_of(args.up);
  if (!args.unit.empty()) options.unit = args.unit;
  auto trials = read_trials(args.in, options, args.out, console);
  if (!trials) return trials.error();
  run.trials = std::move(*trials);
  run.times.read_s = watch.seconds();
  return Done{};
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
  if (const Status ok = solve_fit(args, map, console, run); !ok) {
    return console.fail(ok.error());
  }
  std::vector<Finding> failures = assess_fit_run(args, run);
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
