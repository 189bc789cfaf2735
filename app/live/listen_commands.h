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

/// What `marey listen` was asked for.
struct ListenArguments {
  std::filesystem::path body;  ///< The avatar that the sender has, too.
  std::filesystem::path out;   ///< A motion of it; empty: not kept.
  std::string from = "127.0.0.1";  ///< "HOST[:PORT]" to listen at.
  std::string rest = "vrm0";
  std::vector<std::filesystem::path> avatars;  ///< At most one: to put it on, live.
  std::vector<std::string> vmc;                ///< Where that goes.
  double rate_hz = 60.0;
  std::optional<double> seconds;
  bool json = false;
};

/// `marey listen BODY`: another performer's VMC, kept as a motion of BODY, put on another
/// body and sent on, or both, until Ctrl-C.
[[nodiscard]] Exit run_listen(const ListenArguments& arguments, Console& console);

/// Adds the command; when it is given it becomes `chosen`. `arguments` must stay in place.
void add_listen_command(CLI::App& app,
                        ListenArguments& arguments,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
