// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// Arguments of `marey record`.
struct RecordArguments {
  std::filesystem::path session;  ///< session.toml or its folder.
  std::filesystem::path out;      ///< Folder of the take.
  std::string trial;
  std::optional<double> seconds;
};

/// Runs `marey record SESSION --out TAKE --trial NAME`, until Ctrl-C or for the given
/// number of seconds.
[[nodiscard]] Exit run_record(const RecordArguments& arguments, Console& console);

/// Adds the command record. The parsed command is stored in `chosen`. Precondition:
/// `args` keeps its address until `chosen` runs.
void add_record_command(CLI::App& app,
                        RecordArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
