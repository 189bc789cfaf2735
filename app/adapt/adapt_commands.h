// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/adapt/adapt_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// `marey adapt MOTION --out OUT`: every posture of a motion brought to constraints, its
/// feet on their footprints, its centre of mass kept (docs/formats/README.md).
[[nodiscard]] Exit run_adapt(const AdaptArguments& args, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_adapt_command(CLI::App& app,
                       AdaptArguments& args,
                       std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
