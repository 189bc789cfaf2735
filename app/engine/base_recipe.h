// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "edit/state/edit_state.h"
#include "engine/clips/make_clip.h"

#include "app/shell/console.h"
#include "core/base/result.h"
#include "core/edit/annotation.h"

namespace marey::app {

/// Returns the tags among annotations: "tag calm" and "tag: calm" give "calm". Ascending,
/// without duplicates; the texts in `more` are tags, too.
[[nodiscard]] std::vector<std::string> tags_of(const Annotations& annotations,
                                               std::vector<std::string> more);

/// Makes the source of a clip from a motion with its contacts, annotations and
/// constraints. Its name and sums stay empty.
[[nodiscard]] engine::ClipSource clip_source_of(edit::EditState state);

/// Reads a motion file. Errors: read_edit_files()'s.
[[nodiscard]] Result<std::vector<engine::ClipSource>> read_base_motion(
    const std::filesystem::path& file, Console& console);

/// Renders a recipe; several results have the names NAME.1, NAME.2 ... . See
/// read_base_sources() for loops. Errors: render_recipe()'s; labelled markers.
[[nodiscard]] Result<std::vector<engine::ClipSource>> render_base_recipe(
    const std::filesystem::path& file, Console& console);

}  // namespace marey::app
