// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/inspect/inspect_body.h"
#include "app/shell/console.h"

namespace marey::app {

/// Arguments of `marey inspect`.
struct InspectArguments {
  std::filesystem::path file;
  InspectBodyOptions body;
  bool json = false;
};

/// Runs `marey inspect FILE`: prints the content of a session, calibration, subject,
/// motion or table.
[[nodiscard]] Exit run_inspect(const std::filesystem::path& file,
                               const InspectBodyOptions& options,
                               bool json,
                               Console& console);

/// Adds the command. Parsing it sets `chosen`. `args` must keep its address.
void add_inspect_command(CLI::App& app,
                         InspectArguments& args,
                         std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
