// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/process/pipeline.h"
#include "app/shell/console.h"

namespace marey::app {

/// Arguments of `marey track | calibrate | solve | process`.
struct SessionArguments {
  PipelineOptions pipeline;
  std::filesystem::path media;  ///< Empty: the folder given in the session.
  bool json = false;
};

/// Arguments of `marey demo`.
struct DemoArguments {
  std::filesystem::path sample;  ///< Folder of the sample session.
  std::filesystem::path out;
};

/// Use of the message with the command that shows the results.
enum class ViewHint { kPrinted, kOmitted };

/// Runs `marey track | calibrate | solve | process`. With `json`, it prints report.json
/// on standard output.
[[nodiscard]] Exit run_session(Stage stage,
                               const PipelineOptions& options,
                               bool json,
                               Console& console,
                               ViewHint hint = ViewHint::kPrinted);

/// Runs `marey demo`: processes the sample session on two mannequins. `sample` is the
/// folder of the session. Writes nothing if the session cannot be read.
[[nodiscard]] Exit run_demo(const std::filesystem::path& sample,
                            const std::filesystem::path& out,
                            Console& console);

/// Adds the commands process, track, calibrate and solve, in this order. The parsed
/// command is stored in `chosen`. Precondition: `args` keeps its address until `chosen`
/// runs.
void add_session_commands(CLI::App& app,
                          SessionArguments& args,
                          std::function<Exit(Console&)>& chosen);

/// Adds the command demo. The parsed command is stored in `chosen`. `args.sample` is the
/// default of its option. Precondition: `args` keeps its address until `chosen` runs.
void add_demo_command(CLI::App& app,
                      DemoArguments& args,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
