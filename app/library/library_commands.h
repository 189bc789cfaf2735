// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/library/build/build_commands.h"
#include "app/library/build/version_commands.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of all commands of `marey library`.
struct LibraryArguments {
  LibraryBuildArguments build;
  LibraryVersionArguments versions;
};

/// Adds the command `library` with its commands.
void add_library_command(CLI::App& app,
                         LibraryArguments& args,
                         std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
