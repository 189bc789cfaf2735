// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/retarget/retarget_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// `marey retarget MOTION AVATAR... --out FILE|FOLDER`: a motion on one body or on many.
/// A body that fails does not stop the others; the exit code is the first failure's.
[[nodiscard]] Exit run_retarget(const RetargetArguments& args, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_retarget_command(CLI::App& app,
                          RetargetArguments& args,
                          std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
