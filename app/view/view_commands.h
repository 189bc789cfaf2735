// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "app/view/page_server.h"
#include "app/view/view_files.h"

namespace marey::app {

/// Arguments of `marey view`.
struct ViewArguments {
  ViewChoice choice;
  std::filesystem::path constraints;  ///< For the first human figure; empty: none.
  std::string query;                  ///< Filter of a list of clips; empty: none.
  PageServerOptions page;
  std::optional<double> seconds;
};

/// Runs `marey view FILE|DIR`: serves the page until Ctrl-C or the time limit. Prints the
/// addresses on standard output.
[[nodiscard]] Exit run_view(const ViewArguments& args, Console& console);

/// A kind of folder with a page of its own, which another part of the program shows.
struct FolderView {
  std::function<bool(const std::filesystem::path&)> fits;
  std::function<Exit(const ViewArguments&, Console&)> run;
};

/// Adds the command. Parsing it sets `chosen`. `args` must keep its address. `library`
/// runs instead of run_view() for the folders that it fits; only they have --query.
void add_view_command(CLI::App& app,
                      ViewArguments& args,
                      FolderView library,
                      std::function<Exit(Console&)>& chosen);

/// Adds the options --port, --lan, --web-root and --no-open.
void add_page_options(CLI::App& command, PageServerOptions& options);

}  // namespace marey::app
