// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "app/view/page_server.h"
#include "app/view/view_files.h"

namespace marey::app {

/// What `marey view` was asked for.
struct ViewArguments {
  ViewChoice choice;
  std::filesystem::path constraints;  ///< Of the first human figure; empty: none.
  PageServerOptions page;
  std::optional<double> seconds;
};

/// `marey view FILE|DIR`: serves the page until Ctrl-C, or for some seconds. Addresses go
/// to standard output.
[[nodiscard]] Exit run_view(const ViewArguments& args, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_view_command(CLI::App& app,
                      ViewArguments& args,
                      std::function<Exit(Console&)>& chosen);

/// Adds --port, --lan, --web-root and --no-open.
void add_page_options(CLI::App& command, PageServerOptions& options);

}  // namespace marey::app
