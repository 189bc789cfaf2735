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

/// What `marey record` was asked for.
struct RecordArguments {
  std::filesystem::path session;  ///< session.toml or its folder.
  std::filesystem::path out;      ///< The take's folder.
  std::string trial;
  std::optional<double> seconds;
};

/// `marey record SESSION --out TAKE --trial NAME`: until Ctrl-C, or for some seconds.
[[nodiscard]] Exit run_record(const RecordArguments& arguments, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_record_command(CLI::App& app,
                        RecordArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
