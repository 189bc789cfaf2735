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

/// Arguments of `marey library check`.
struct LibraryCheckArguments {
  std::filesystem::path library;
  std::string query;             ///< Selection of the clips; empty: all.
  std::string fail_on = "fail";  ///< Verdict that leads to exit code 4: "warn" or "fail".
  bool json = false;
  std::filesystem::path page;  ///< Empty: check.html in the library.
};

/// Prints the quality of a library's clips, and writes it as a page. Exit code 4 if a
/// clip fails, or warns with `fail_on` "warn". A page in a library that cannot be written
/// is a warning only.
Exit run_library_check(const LibraryCheckArguments& args, Console& console);

/// Adds the command `check` to `marey library`.
void add_library_check_command(CLI::App& library,
                               LibraryCheckArguments& args,
                               std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
