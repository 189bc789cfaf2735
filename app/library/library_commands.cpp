// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/library_commands.h"

namespace marey::app {

void add_library_command(CLI::App& app,
                         LibraryArguments& args,
                         std::function<Exit(Console&)>& chosen) {
  CLI::App* library =
      app.add_subcommand("library", "Build, check, search and export motion libraries");
  library->require_subcommand(1);
  add_library_build_commands(*library, args.build, chosen);
  add_library_version_commands(*library, args.versions, chosen);
}

}  // namespace marey::app
