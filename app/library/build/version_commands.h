// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of `marey library versions` and `diff`.
struct LibraryVersionArguments {
  std::filesystem::path library;
  int before = 0;  ///< Number of a version.
  int after = 0;
  bool json = false;
};

/// Prints the versions of a library: number, SHA-256, date, clips and their quality.
Exit run_library_versions(const LibraryVersionArguments& args, Console& console);

/// Prints the clips that differ between two versions, and in what: source, motion,
/// quality, labels, licence.
Exit run_library_diff(const LibraryVersionArguments& args, Console& console);

/// Adds these commands to `marey library`.
void add_library_version_commands(CLI::App& library,
                                  LibraryVersionArguments& args,
                                  std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
