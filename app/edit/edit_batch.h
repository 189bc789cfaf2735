// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/edit/edit_outputs.h"
#include "app/edit/edit_run.h"
#include "app/shell/console.h"
#include "app/shell/exit_codes.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

/// Returns the files that a pattern names, ascending: * and ? stand for any characters of
/// one name, also of a folder's. Errors (bad input): none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> files_of_pattern(
    const std::string& pattern);

/// Returns a name for the result of each file: its path below the folder that all have in
/// common, without the extension, with points for slashes. Names are all different.
[[nodiscard]] std::vector<std::string> names_of_files(
    const std::vector<std::filesystem::path>& files);

struct EditBatchOptions {
  EditRunOptions run;
  bool check = false;  ///< Writes nothing.
};

/// Applies one recipe to many motions or files of labelled markers, in parallel by file,
/// each as the first source.
/// Goes on after a failure. Writes the results and edit.csv, a line per result; no
/// result overwrites one of the motions. Returns
/// kQualityGate if a motion failed or a figure is above its limit. Same bytes for any
/// number of threads.
Exit run_edit_batch(const EditRecipe& recipe,
                    const std::filesystem::path& recipe_file,
                    const std::vector<std::filesystem::path>& motions,
                    EditOutput output,
                    const EditBatchOptions& options,
                    Console& console);

}  // namespace marey::app
