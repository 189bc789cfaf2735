// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/jump/jump_options.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Runs `marey jump MOTION --out OUT`: makes one jump of a motion higher, longer or
/// different, and writes the motion (docs/jumps.md). Nothing else is written.
[[nodiscard]] Exit run_jump(const JumpArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_jump_command(CLI::App& app,
                      JumpArguments& args,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
