// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "app/stage/live/stage_live.h"
#include "app/stage/run/scene_run.h"
#include "app/stage/run/stage_bodies.h"
#include "core/base/result.h"

namespace marey::app {

/// Arguments of `marey stage`.
struct StageArguments {
  std::filesystem::path scene;
  std::filesystem::path out;  ///< Folder; empty: nothing is written.
  /// Instead of the scene's duration; with `live`: the program stops then.
  std::optional<double> seconds{};
  std::optional<double> budget{};  ///< Instead of the scene's budget.
  bool json = false;
  bool live = false;  ///< On the page and by VMC, in real time.
  StageLiveOptions live_options{};
};

/// A scene with everything that it names.
struct OpenedScene {
  SceneRunInput input{};
  StageCast cast{};
};

/// Reads a scene, its base, floor, bodies, constraints and trials. Errors: those of
/// reading each, with its file.
[[nodiscard]] Result<OpenedScene> open_scene(const StageArguments& args);

/// Runs `marey stage SCENE.toml`: plays a scene (docs/formats/scene.md), prints its
/// figures and writes its results. Exit code 3 if an action could not begin, 4 if a
/// figure does not meet its bounds; results are written in both cases.
[[nodiscard]] Exit run_stage(const StageArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_stage_command(CLI::App& app,
                       StageArguments& args,
                       std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
