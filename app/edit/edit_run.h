// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "edit/render.h"
#include <nlohmann/json_fwd.hpp>

#include "app/edit/edit_inputs.h"
#include "app/edit/marker_edit_run.h"
#include "app/shell/console.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

/// A recipe with its files and its result.
struct EditRun {
  EditRecipe recipe;
  EditFiles files;
  edit::Rendered rendered;
};

struct EditRunOptions {
  bool accept_new_sources = false;     ///< As ReadEditOptions'.
  std::optional<std::size_t> until{};  ///< Number of operations; nullopt: all.
};

/// Reads a recipe; its name is the file's if it states none. Errors (bad input): another
/// extension; read_edit_recipe()'s.
[[nodiscard]] Result<EditRecipe> read_named_recipe(const std::filesystem::path& file);

[[nodiscard]] ReadEditOptions options_of_reading(const std::filesystem::path& recipe_file,
                                                 const EditRunOptions& options);

/// Reads the files of a recipe and renders it. `file` is the recipe's. Errors:
/// read_edit_files()'s and render()'s.
[[nodiscard]] Result<EditRun> render_recipe(const std::filesystem::path& file,
                                            EditRecipe recipe,
                                            const EditRunOptions& options,
                                            Console& console);
/// Renders a recipe whose files were read. `recipe_file` is for the place of errors; may
/// be empty. Errors: render()'s.
[[nodiscard]] Result<EditRun> render_read_files(const std::string& recipe_file,
                                                EditRecipe recipe,
                                                EditFiles files,
                                                std::optional<std::size_t> until,
                                                Console& console);
/// The same for labelled markers. Errors: run_marker_edit()'s.
[[nodiscard]] Result<MarkerEditRun> render_marker_recipe(
    const std::filesystem::path& file,
    EditRecipe recipe,
    const EditRunOptions& options,
    Console& console);

/// Prints on standard output.
void print_edit_json(const nlohmann::ordered_json& json);

}  // namespace marey::app
