// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/live/live_session.h"
#include "app/shell/console.h"

namespace marey::app {

/// Runs `marey live SESSION`: tracks the subject and sends packets until Ctrl-C, the time
/// limit or the end of the videos.
[[nodiscard]] Exit run_live_command(const LiveArguments& arguments, Console& console);

/// Adds the command. Parsing it sets `chosen`. `live` must keep its address.
void add_live_command(CLI::App& app,
                      LiveArguments& live,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
