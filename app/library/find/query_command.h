// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of `marey library query`.
struct LibraryQueryArguments {
  std::filesystem::path library;
  std::string expression;
  int limit = 0;  ///< Maximum number of clips that are listed; 0: all.
  bool count = false;
  bool json = false;
};

/// Lists the clips that an expression selects (docs/library_queries.md) on standard
/// output: a table, JSON, or their number alone. Exit code 0 also if there are none.
Exit run_library_query(const LibraryQueryArguments& args, Console& console);

/// Adds the command `query` to `marey library`.
void add_library_query_command(CLI::App& library,
                               LibraryQueryArguments& args,
                               std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
