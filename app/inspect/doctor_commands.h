// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "app/shell/console.h"

namespace marey::app {

/// Arguments of `marey doctor`.
struct DoctorArguments {
  bool json = false;
};

/// Runs `marey doctor`: reports the resources of this machine and checks them.
[[nodiscard]] Exit run_doctor(bool json, Console& console);

/// Adds the command. Parsing it sets `chosen`. `args` must keep its address.
void add_doctor_command(CLI::App& app,
                        DoctorArguments& args,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
