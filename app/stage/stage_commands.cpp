// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/stage_commands.h"

#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/edit/edit_run.h"
#include "app/engine/open_base.h"
#include "app/shell/findings.h"
#include "app/shell/option_checks.h"
#include "app/stage/figures/measure_figures.h"
#include "app/stage/stage_results.h"
#include "core/base/format_text.h"
#include "recordings/body/floor_file.h"
#include "recordings/scene/read_scene.h"
#include "recordings/scene/read_trials.h"

namespace marey::app {
namespace {

Status read_scene_trials(SceneRunInput& input) {
  for (const SceneAction& action : input.scene.script) {
    const auto* deed = std::get_if<SceneThrow>(&action.deed);
    if (deed == nullptr || deed->trials.empty()) continue;
    auto trials = recordings::read_trials(deed->trials);
    if (!trials) return trials.error();
    input.trials[deed->trials] = *std::move(trials);
  }
  return Done{};
}

}  // namespace

Result<OpenedScene> open_scene(const StageArguments& args) {
  OpenedScene out;
  auto scene = recordings::read_scene(args.scene);
  if (!scene) return scene.error();
  out.input.scene = *std::move(scene);
  if (args.seconds && !args.live) out.input.scene.duration_s = *args.seconds;
  if (args.budget) out.input.scene.budget_units = args.budget;
  auto base = open_base(out.input.scene.base);
  if (!base) return base.error();
  out.input.base = *std::move(base);
  if (!out.input.scene.floor.empty()) {
    auto floor = recordings::read_floor(out.input.scene.floor);
    if (!floor) return floor.error();
    out.input.floor = *std::move(floor);
  }
  if (const Status ok = read_scene_trials(out.input); !ok) return ok.error();
  auto cast = read_stage_cast(out.input.scene);
  if (!cast) return cast.error();
  out.cast = *std::move(cast);
  out.input.bodies = out.cast.bodies;
  return out;
}

Exit run_stage(const StageArguments& args, Console& console) {
  if (!args.out.empty()) {
    const Status ok = check_stage_folder(args.out);
    if (!ok) return console.fail(ok.error());
  }
  auto opened = open_scene(args);
  if (!opened) return console.fail(opened.error());
  if (args.live) {
    StageLiveOptions options = args.live_options;
    options.seconds = args.seconds;
    return run_stage_live(std::move(opened->input), options, console);
  }
  auto run = SceneRun::make(std::move(opened->input));
  if (!run) return console.fail(run.error());
  const Progress progress = console.stage("scene");
  const int steps =
      static_cast<int>(run->scene().duration_s * run->scene().step_hz + 0.5);
  for (int step = 0; step < steps; ++step) {
    run->advance();
    progress(step + 1, steps);
  }
  StageResult result{run->record(), opened->cast, {}, run->problems()};
  result.figures = measure_figures(result.record);
  if (!args.out.empty()) {
    const auto files = write_stage(result, args.out);
    if (!files) return console.fail(files.error());
    for (const auto& file : *files) console.say(file.string());
  }
  if (args.json) print_edit_json(stage_json(result));
  for (const std::string& line : stage_lines(result)) console.say(line);
  console.say(format_text("%s: %zu bodies, %.2f s, %.3f ms a step",
                          result.record.scene.name.c_str(),
                          run->size(),
                          run->time_s(),
                          result.record.mean_step_ms));
  const auto findings = assess_stage(result);
  const Exit exit = print_failures(console, findings);
  // The actions of a scene before its figures.
  return result.problems.empty() ? exit : Exit::kBadInput;
}

void add_stage_command(CLI::App& app,
                       StageArguments& args,
                       std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand("stage", "Play a scene of several characters");
  command->add_option("SCENE", args.scene, "Scene (.toml)")->required();
  CLI::Option* out = command->add_option("-o,--out", args.out, "Folder for the results");
  command
      ->add_option(
          "--seconds",
          args.seconds,
          "Duration instead of the scene's; with --live: stop after this time [s]")
      ->check(between(0.01, 1e5));
  command->add_option("--budget", args.budget, "Cost of a step instead of the scene's")
      ->check(between(0.0, 1e9));
  CLI::Option* json =
      command->add_flag("--json", args.json, "Prints stage.json on standard output");
  command->add_flag("--live", args.live, "In real time, on a page in a browser")
      ->excludes(out)
      ->excludes(json);
  add_stage_live_options(*command, args.live_options);
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_stage(args, console); }; });
}

}  // namespace marey::app
