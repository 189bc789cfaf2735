// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/clips/make_clip.h"

#include "app/shell/console.h"
#include "core/base/result.h"

namespace marey::app {

/// Motions from which `marey base build` makes clips.
struct BaseInputs {
  /// Motion files, recipes (.edit.toml), folders of them, and libraries.
  std::vector<std::filesystem::path> paths;
  /// Selects the clips of libraries (docs/library_queries.md). With it, all paths are
  /// libraries.
  std::optional<std::string> query;
  std::vector<std::string> loops;  ///< Names of clips that loop.
};

/// Returns whether a folder is a motion library with an index.
[[nodiscard]] bool is_library(const std::filesystem::path& folder);

/// Returns the motion files and recipes of a folder, without its subfolders, ascending by
/// name. A motion is left out if there is a recipe of its name.
/// Errors (bad input): it holds none, or cannot be read.
[[nodiscard]] Result<std::vector<std::filesystem::path>> base_files_of(
    const std::filesystem::path& folder);

/// Reads all motions, renders the recipes, and returns what the clips are made from, in
/// the order of the paths.
///
/// The name of a clip is the stem of its file, of the recipe, or the name of the clip in
/// its library. Tags are annotations that begin with "tag", and the texts of the recipe's
/// operations `tag`, and in a library the labels of people and tables. A recipe gives a
/// loop if no operation that changes the duration follows its last `cyclify`; the loop is
/// closed by the first frame of the next cycle.
///
/// Errors: those of read_edit_files(), render(), run_clip_query() and ClipMotions; two
/// clips of one name; a name in `loops` without a clip (usage).
[[nodiscard]] Result<std::vector<engine::ClipSource>> read_base_sources(
    const BaseInputs& inputs, Console& console);

}  // namespace marey::app
