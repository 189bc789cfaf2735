// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/engine/blend_inputs.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Runs `marey blend`: plays one transition and writes it (docs/formats/blend.md).
[[nodiscard]] Exit run_blend(const BlendArguments& args, Console& console);

/// Adds the command. If the user gives it, `chosen` runs it. `args` must stay in place.
void add_blend_command(CLI::App& app,
                       BlendArguments& args,
                       std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
