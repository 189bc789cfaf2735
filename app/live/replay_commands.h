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

/// Arguments of `marey replay`.
struct ReplayArguments {
  std::filesystem::path take;    ///< Folder written by `marey live --record`.
  std::vector<std::string> vmc;  ///< As LiveArguments::vmc; empty: no packets.
  double speed = 1.0;            ///< Factor of the recorded speed.
  bool fast = false;             ///< Without pauses.
  bool json = false;
};

/// Runs `marey replay TAKE`: processes a recorded live run with the code of the live run,
/// and compares the resulting bytes with the recorded ones.
[[nodiscard]] Exit run_replay(const ReplayArguments& arguments, Console& console);

/// Adds the command. Parsing it sets `chosen`. `args` must keep its address.
void add_replay_command(CLI::App& app,
                        ReplayArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
