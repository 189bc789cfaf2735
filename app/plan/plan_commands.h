// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// Arguments of `marey plan`.
struct PlanArguments {
  std::filesystem::path plan;  ///< plan.toml or calibration.toml.
  std::filesystem::path out;   ///< Folder for plan.json and plan.html.
  std::optional<double> tag_size_m;
  std::optional<double> stature_m;
  bool json = false;
};

/// Runs `marey plan PLAN --out DIR`: predicts what the cameras of a rig see, and the
/// errors of tags and joints.
[[nodiscard]] Exit run_plan(const PlanArguments& args, Console& console);

/// Adds the command plan. The parsed command is stored in `chosen`. Precondition: `args`
/// keeps its address until `chosen` runs.
void add_plan_command(CLI::App& app,
                      PlanArguments& args,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
