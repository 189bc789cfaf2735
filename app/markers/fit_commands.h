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

/// What `marey fit` was asked for.
struct FitArguments {
  std::vector<std::filesystem::path> in;  ///< C3D or TRC, of one subject.
  std::filesystem::path out;              ///< Folder of the results.
  std::filesystem::path map;              ///< What labels mean; may be empty.
  std::filesystem::path subject;          ///< An earlier fit's; may be empty.
  std::string name;
  std::optional<double> stature_m;
  std::optional<double> mass_kg;
  std::vector<std::filesystem::path> avatars;
  std::string up;    ///< "+Z", checked; empty where the files decide.
  std::string unit;  ///< Likewise "mm".
  bool json = false;
};

/// `marey fit IN... --out DIR`: the subject who wore these labelled markers, and its
/// motion in every file (docs/formats/README.md).
[[nodiscard]] Exit run_fit(const FitArguments& args, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_fit_command(CLI::App& app,
                     FitArguments& args,
                     std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
