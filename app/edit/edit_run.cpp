// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_run.h"

#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "recordings/edit/edit_recipe_file.h"

namespace marey::app {

namespace fs = std::filesystem;

Result<EditRecipe> read_named_recipe(const fs::path& file) {
  if (!file.string().ends_with(".toml")) {
    return bad_input(
        file.string(),
        "is not a recipe (.edit.toml)",
        "make one for this file with --new RECIPE.edit.toml, or edit a motion in "
        "a browser with --page");
  }
  auto recipe = recordings::read_edit_recipe(file);
  if (!recipe || !recipe->name.empty()) return recipe;
  recipe->name = file.stem().string();
  if (recipe->name.ends_with(".edit")) recipe->name.resize(recipe->name.size() - 5);
  return recipe;
}

ReadEditOptions options_of_reading(const fs::path& recipe_file,
                                   const EditRunOptions& options) {
  return {recipe_file.parent_path(), recipe_file.string(), options.accept_new_sources};
}

Result<EditRun> render_recipe(const fs::path& file,
                              EditRecipe recipe,
                              const EditRunOptions& options,
                              Console& console) {
  auto files = read_edit_files(recipe, options_of_reading(file, options));
  if (!files) return files.error();
  return render_read_files(
      file.string(), std::move(recipe), *std::move(files), options.until, console);
}

Result<EditRun> render_read_files(const std::string& recipe_file,
                                  EditRecipe recipe,
                                  EditFiles files,
                                  std::optional<std::size_t> until,
                                  Console& console) {
  EditRun run;
  run.recipe = std::move(recipe);
  run.files = std::move(files);
  edit::RenderOptions render;
  render.recipe_file = recipe_file;
  render.until = until;
  auto rendered = edit::render(
      run.recipe, std::move(run.files.inputs), render, console.stage("edit"));
  if (!rendered) return rendered.error();
  run.rendered = *std::move(rendered);
  return run;
}

Result<MarkerEditRun> render_marker_recipe(const fs::path& file,
                                           EditRecipe recipe,
                                           const EditRunOptions& options,
                                           Console& console) {
  const MarkerEditRunOptions run{options_of_reading(file, options), options.until};
  return run_marker_edit(std::move(recipe), run, console.stage("edit"));
}

void print_edit_json(const nlohmann::ordered_json& json) {
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  std::printf("%s\n", json.dump(2, ' ', false, kReplace).c_str());
}

}  // namespace marey::app
