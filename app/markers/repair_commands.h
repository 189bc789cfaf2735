// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// What `marey repair` was asked for.
struct RepairArguments {
  std::filesystem::path in;   ///< C3D or TRC.
  std::filesystem::path out;  ///< Likewise.
  double max_sigma_m = 0.1;
  bool json = false;
};

/// `marey repair IN --out OUT`: OUT is IN with wrong samples taken out or put right and
/// gaps filled; beside it OUT's name with `.repair.csv` tells of every sample that was
/// changed, with `.repair.json` of every fault and gap, and with `.repair.html` shows
/// them.
[[nodiscard]] Exit run_repair(const RepairArguments& args, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_repair_command(CLI::App& app,
                        RepairArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
