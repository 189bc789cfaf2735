// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/convert/convert_arguments.h"
#include "app/shell/console.h"

namespace marey::app {

/// `marey convert IN OUT`: labelled markers, or the motion of a skeleton, from one kind
/// of file to another.
[[nodiscard]] Exit run_convert(const ConvertArguments& arguments, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_convert_command(CLI::App& app,
                         ConvertArguments& args,
                         std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
