// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/inspect/inspect_body.h"
#include "app/shell/console.h"

namespace marey::app {

/// What `marey inspect` was asked for.
struct InspectArguments {
  std::filesystem::path file;
  InspectBodyOptions body;
  bool json = false;
};

/// `marey inspect FILE`: what a session, calibration, subject, motion or table holds.
[[nodiscard]] Exit run_inspect(const std::filesystem::path& file,
                               const InspectBodyOptions& options,
                               bool json,
                               Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_inspect_command(CLI::App& app,
                         InspectArguments& args,
                         std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
