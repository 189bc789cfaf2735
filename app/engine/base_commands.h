// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/engine/base_sources.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of the commands of `marey base`.
struct BaseArguments {
  BaseInputs inputs;
  std::filesystem::path out;   ///< For `build`.
  std::filesystem::path file;  ///< For `list` and `check`.
  bool json = false;
};

/// Runs `marey base build PATH... --out moves.marey`: makes the clips of an engine from
/// motions, recipes and libraries (docs/formats/moves.md), and prints them as `list`. An
/// existing file is replaced; none of the inputs is.
[[nodiscard]] Exit run_base_build(const BaseArguments& args, Console& console);

/// Runs `marey base list FILE`: prints the clips on standard output.
[[nodiscard]] Exit run_base_list(const BaseArguments& args, Console& console);

/// Runs `marey base check FILE`: reads all of it. Exit code 3 with the cause if it is
/// damaged, or its clips cannot be played.
[[nodiscard]] Exit run_base_check(const BaseArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_base_command(CLI::App& app,
                      BaseArguments& args,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
