// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// Arguments of `marey repair`.
struct RepairArguments {
  std::filesystem::path in;   ///< C3D or TRC.
  std::filesystem::path out;  ///< C3D or TRC.
  double max_sigma_m = 0.1;
  bool json = false;
};

/// Runs `marey repair INPUT --out OUT`: writes OUT with wrong samples removed or
/// corrected and gaps filled. In the same folder, OUT.repair.csv lists every changed
/// sample, OUT.repair.json every fault and gap, and OUT.repair.html shows them.
[[nodiscard]] Exit run_repair(const RepairArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_repair_command(CLI::App& app,
                        RepairArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
