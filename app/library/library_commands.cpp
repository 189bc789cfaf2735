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
  add_library_check_command(*library, args.check, chosen);
  add_library_query_command(*library, args.query, chosen);
  add_library_similar_command(*library, args.similar, chosen);
  add_library_annotate_command(*library, args.annotate, chosen);
  add_library_export_command(*library, args.exported, chosen);
  add_library_version_commands(*library, args.versions, chosen);
}

}  // namespace marey::app
