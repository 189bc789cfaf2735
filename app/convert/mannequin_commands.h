// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"
#include "recordings/body/mannequin.h"

namespace marey::app {

/// Arguments of `marey mannequin`.
struct MannequinArguments {
  recordings::MannequinOptions options;
  recordings::MannequinStyle style;
  std::filesystem::path out;  ///< .glb
};

/// Runs `marey mannequin --out body.glb`: writes a skinned mannequin as GLB.
[[nodiscard]] Exit run_mannequin(const recordings::MannequinOptions& options,
                                 const recordings::MannequinStyle& style,
                                 const std::filesystem::path& out,
                                 Console& console);

/// Adds the command. Parsing it sets `chosen`. `args` must keep its address.
void add_mannequin_command(CLI::App& app,
                           MannequinArguments& args,
                           std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
