// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/markers/fit_run.h"
#include "app/shell/console.h"

namespace marey::app {

/// Runs `marey fit INPUT... --out DIR`: fits the subject to labelled markers and writes
/// its motion in every format (docs/formats/README.md).
[[nodiscard]] Exit run_fit(const FitArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_fit_command(CLI::App& app,
                     FitArguments& args,
                     std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
