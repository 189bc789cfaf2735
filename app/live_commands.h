// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/console.h"
#include "app/live_session.h"

namespace marey::app {

/// What `marey replay` was asked for.
struct ReplayArguments {
  std::filesystem::path take;     ///< The folder that `marey live --record` made.
  std::vector<std::string> vmc;   ///< As LiveArguments::vmc; empty: nowhere.
  double speed = 1.0;             ///< 1: as it was.
  bool fast = false;              ///< As fast as it goes.
  bool json = false;
};

/// `marey live SESSION`: from cameras to packets, until Ctrl-C or the end.
[[nodiscard]] Exit run_live_command(const LiveArguments& arguments, Console& console);

/// `marey replay TAKE`: a recorded live run through the same code again, and whether the
/// same bytes come of it.
[[nodiscard]] Exit run_replay(const ReplayArguments& arguments, Console& console);

/// Adds the commands; one that is given becomes `chosen`. Arguments must stay in place.
void add_live_commands(CLI::App& app,
                       LiveArguments& live,
                       ReplayArguments& replay,
                       std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
