// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/edit/edit_page.h"
#include "app/edit/edit_run.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"

namespace marey::app {

/// Arguments of `marey edit`.
struct EditArguments {
  std::filesystem::path recipe;
  std::filesystem::path out;
  std::vector<std::string>
      formats;  ///< Empty: .npz, .bvh, .glb and .vrma that fit, or .c3d and .trc.
  std::optional<int> until;          ///< Number of operations to apply.
  std::string each;                  ///< Pattern of motions; empty: the recipe's source.
  std::filesystem::path new_recipe;  ///< Recipe to make for the motion `recipe`.
  bool check = false;
  bool pin = false;
  bool accept_new_source = false;
  bool json = false;
  bool serves_page = false;  ///< Serves the page; `page` has its other arguments.
  EditPageArguments page;
  std::filesystem::path diff_first;
  std::filesystem::path diff_second;
};

[[nodiscard]] EditRunOptions run_options(const EditArguments& args);

/// Renders a recipe and writes its results; with `each`, once for each motion; with
/// `serves_page`, whenever a page asks for it. Exit code 4 if a figure is above a limit
/// of the recipe, or a motion of many fails.
Exit run_edit(const EditArguments& args, Console& console);

/// Prints which operations two recipes differ in, and the largest difference of a joint
/// or of a marker between their results.
Exit run_edit_diff(const EditArguments& args, Console& console);

/// Adds the command `edit`, with `edit diff`.
void add_edit_command(CLI::App& app,
                      EditArguments& args,
                      std::function<Exit(Console&)>& chosen);

}  // namespace marey::app
