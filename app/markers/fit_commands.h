// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// Arguments of `marey fit`.
struct FitArguments {
  std::vector<std::filesystem::path> in;  ///< C3D or TRC, of one subject.
  std::filesystem::path out;              ///< Folder of the results.
  std::filesystem::path map;              ///< Meaning of the labels; may be empty.
  std::filesystem::path subject;          ///< subject.toml of an earlier fit, or empty.
  std::string name;
  std::optional<double> stature_m;
  std::optional<double> mass_kg;
  std::vector<std::filesystem::path> avatars;
  std::string up;    ///< "+Z", checked; empty: as in the files.
  std::string unit;  ///< "mm", checked; empty: as in the files.
  bool json = false;
};

/// Runs `marey fit INPUT... --out DIR`: fits the subject to labelled markers and writes
/// its motion in every format (docs/formats/README.md).
[[nodiscard]] Exit run_fit(const FitArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_fit_command(CLI::App& app,
                     FitArguments& args,
                     std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
