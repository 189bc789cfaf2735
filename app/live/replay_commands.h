// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// What `marey replay` was asked for.
struct ReplayArguments {
  std::filesystem::path take;    ///< The folder that `marey live --record` made.
  std::vector<std::string> vmc;  ///< As LiveArguments::vmc; empty: nowhere.
  double speed = 1.0;            ///< 1: as it was.
  bool fast = false;             ///< As fast as it goes.
  bool json = false;
};

/// `marey replay TAKE`: a recorded live run through the same code again, and whether the
/// same bytes come of it.
[[nodiscard]] Exit run_replay(const ReplayArguments& arguments, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_replay_command(CLI::App& app,
                        ReplayArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
