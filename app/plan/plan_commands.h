// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// What `marey plan` was asked for.
struct PlanArguments {
  std::filesystem::path plan;  ///< plan.toml or calibration.toml.
  std::filesystem::path out;   ///< Folder for plan.json and plan.html.
  std::optional<double> tag_size_m;
  std::optional<double> stature_m;
  bool json = false;
};

/// `marey plan PLAN --out DIR`: what a rig would see, and how well.
[[nodiscard]] Exit run_plan(const PlanArguments& args, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_plan_command(CLI::App& app,
                      PlanArguments& args,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
