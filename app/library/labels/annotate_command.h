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

/// Arguments of `marey library annotate`.
struct LibraryAnnotateArguments {
  std::filesystem::path library;
  std::filesystem::path import;  ///< A table of labels (.csv) or a file of BABEL (.json).
  /// Name of the table in labels/, and author of rows without one; empty: the import's.
  std::string by;
  bool replace = false;
  bool json = false;
};

/// Stores the labels of a file in labels/NAME.csv of a library, for its next build. Names
/// of clips and sources must be known; others are counted and reported. Exit code 3 if no
/// label fits.
Exit run_library_annotate(const LibraryAnnotateArguments& args, Console& console);

/// Adds the command `annotate` to `marey library`.
void add_library_annotate_command(CLI::App& library,
                                  LibraryAnnotateArguments& args,
                                  std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
