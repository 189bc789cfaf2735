// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/live/live_session.h"
#include "app/shell/console.h"

namespace marey::app {

/// `marey live SESSION`: from cameras to packets, until Ctrl-C or the end.
[[nodiscard]] Exit run_live_command(const LiveArguments& arguments, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `live` must stay in place.
void add_live_command(CLI::App& app,
                      LiveArguments& live,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
