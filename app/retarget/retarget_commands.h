// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/retarget/retarget_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// Runs `marey retarget MOTION AVATAR... --out FILE|FOLDER`: puts a motion on one or more
/// bodies. If one body fails, the others are still processed. Returns the exit code of
/// the first failure.
[[nodiscard]] Exit run_retarget(const RetargetArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_retarget_command(CLI::App& app,
                          RetargetArguments& args,
                          std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
