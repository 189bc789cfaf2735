// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/convert/convert_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// Runs `marey convert INPUT OUTPUT`: converts labelled markers, or the motion of a
/// skeleton, to another file format.
[[nodiscard]] Exit run_convert(const ConvertArguments& arguments, Console& console);

/// Adds the command. Parsing it sets `chosen`. `args` must keep its address.
void add_convert_command(CLI::App& app,
                         ConvertArguments& args,
                         std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
