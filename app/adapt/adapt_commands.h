// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/adapt/adapt_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// Runs `marey adapt MOTION --out OUT`: adapts every posture of a motion to constraints,
/// keeps its feet on their footprints and its centre of mass (docs/formats/README.md).
[[nodiscard]] Exit run_adapt(const AdaptArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_adapt_command(CLI::App& app,
                       AdaptArguments& args,
                       std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
