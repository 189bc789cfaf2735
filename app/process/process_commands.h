// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/process/pipeline.h"
#include "app/shell/console.h"

namespace marey::app {

/// What `marey track | calibrate | solve | process` was asked for.
struct SessionArguments {
  PipelineOptions pipeline;
  std::filesystem::path media;  ///< Empty: the session's.
  bool json = false;
};

/// What `marey demo` was asked for.
struct DemoArguments {
  std::filesystem::path sample;  ///< Folder of the sample session.
  std::filesystem::path out;
};

/// `marey track | calibrate | solve | process`. With `json`, report.json goes to standard
/// output.
[[nodiscard]] Exit run_session(Stage stage,
                               const PipelineOptions& options,
                               bool json,
                               Console& console);

/// `marey demo`: the sample session on two mannequins. `sample` is its folder.
[[nodiscard]] Exit run_demo(const std::filesystem::path& sample,
                            const std::filesystem::path& out,
                            Console& console);

/// Adds process, track, calibrate and solve, in this order; one that is given becomes
/// `chosen`. `args` must stay in place.
void add_session_commands(CLI::App& app,
                          SessionArguments& args,
                          std::function<Exit(Console&)>& chosen);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place;
/// `args.sample` is the default.
void add_demo_command(CLI::App& app,
                      DemoArguments& args,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
