// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// What `marey doctor` was asked for.
struct DoctorArguments {
  bool json = false;
};

/// `marey doctor`: what this machine has, and whether it is enough.
[[nodiscard]] Exit run_doctor(bool json, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `args` must stay in place.
void add_doctor_command(CLI::App& app,
                        DoctorArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
