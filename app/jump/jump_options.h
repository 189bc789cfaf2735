// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

/// Arguments of `marey jump`.
struct JumpArguments {
  std::filesystem::path motion;
  std::filesystem::path out;
  std::filesystem::path character;  ///< A character.toml; empty: the motion's own body.
  std::optional<double> apex_by_cm{};
  std::optional<double> apex_m{};
  std::optional<double> airtime_s{};
  std::optional<double> length_m{};
  std::string landing_m;  ///< "X,Y,Z" or empty.
  std::optional<double> box_cm{};
  std::optional<double> push_s{};
  std::optional<double> push_start_s{};
  std::string law = "force";
  std::optional<double> strength_g{};
  double gravity_m_s2 = 9.81;
  bool ballistic = false;
  bool drop_momentum = false;
  int jump = 1;
  bool json = false;
};

/// Adds the options of `marey jump`. Their ranges are those of the keys of recipes.
void add_jump_options(CLI::App& command, JumpArguments& args);

/// Returns the recipe of one operation that the arguments describe. Its source is the
/// motion. Precondition: the options' checks passed.
[[nodiscard]] EditRecipe jump_recipe(const JumpArguments& args);

/// Returns a message of the operation with the options in place of the keys of recipes:
/// "--apex" for "apex_m". Other words stay.
[[nodiscard]] std::string with_jump_options(const std::string& text);

}  // namespace marey::app
