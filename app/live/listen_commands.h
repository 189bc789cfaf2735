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

/// Arguments of `marey listen`.
struct ListenArguments {
  std::filesystem::path body;      ///< Avatar; the sender uses the same one.
  std::filesystem::path out;       ///< Output file; empty: nothing is written.
  std::string from = "127.0.0.1";  ///< Address to listen on, "HOST[:PORT]".
  std::string rest = "vrm0";
  std::vector<std::filesystem::path> avatars;  ///< Live retargeting target; at most one.
  std::vector<std::string> vmc;                ///< Targets of its packets.
  double rate_hz = 60.0;
  std::optional<double> seconds;
  bool json = false;
};

/// Runs `marey listen BODY`: receives VMC until Ctrl-C, and writes it as a motion of
/// BODY, or retargets it to another body and sends that as VMC, or both.
[[nodiscard]] Exit run_listen(const ListenArguments& arguments, Console& console);

/// Adds the command. Parsing it sets `chosen`. `arguments` must keep its address.
void add_listen_command(CLI::App& app,
                        ListenArguments& arguments,
                        std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
