// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/library/find/similar_clips.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of `marey library similar`.
struct LibrarySimilarArguments {
  std::filesystem::path library;
  std::string query;  ///< CLIP, CLIP@a-b, FILE or FILE@a-b.
  SimilarClipsOptions options;
  bool json = false;
};

/// Lists the clips that are most similar to a motion on standard output: id, name, part,
/// distance and labels. Exit code 0 also if there are none.
Exit run_library_similar(const LibrarySimilarArguments& args, Console& console);

/// Adds the command `similar` to `marey library`.
void add_library_similar_command(CLI::App& library,
                                 LibrarySimilarArguments& args,
                                 std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
