// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "recordings/body/mannequin.h"

namespace marey::app {

/// What `marey mannequin` was asked for.
struct MannequinArguments {
  recordings::MannequinOptions options;
  recordings::MannequinStyle style;
  std::filesystem::path out;  ///< .glb
};

/// `marey mannequin --out body.glb`.
[[nodiscard]] Exit run_mannequin(const recordings::MannequinOptions& options,
                                 const recordings::MannequinStyle& style,
                                 const std::filesystem::path& out,
                                 Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_mannequin_command(CLI::App& app,
                           MannequinArguments& args,
                           std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
