// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/shell/console.h"
#include "app/view/view_commands.h"

namespace marey::app {

/// Returns true if a folder is a motion library: it has a library.toml.
[[nodiscard]] bool is_library_folder(const std::filesystem::path& path);

/// Runs `marey view LIB`: serves the page of a library until Ctrl-C or the time limit.
/// Prints the addresses on standard output.
[[nodiscard]] Exit run_library_view(const ViewArguments& args, Console& console);

/// Returns the part of `marey view` that shows libraries.
[[nodiscard]] FolderView library_folder_view();

}  // namespace marey::app
