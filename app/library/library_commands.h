// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/library/build/build_commands.h"
#include "app/library/build/version_commands.h"
#include "app/library/check/check_command.h"
#include "app/library/export/export_commands.h"
#include "app/library/find/query_command.h"
#include "app/library/find/similar_command.h"
#include "app/library/labels/annotate_command.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of all commands of `marey library`.
struct LibraryArguments {
  LibraryBuildArguments build;
  LibraryVersionArguments versions;
  LibraryCheckArguments check;
  LibraryQueryArguments query;
  LibrarySimilarArguments similar;
  LibraryAnnotateArguments annotate;
  LibraryExportArguments exported;
};

/// Adds the command `library` with its commands.
void add_library_command(CLI::App& app,
                         LibraryArguments& args,
                         std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
