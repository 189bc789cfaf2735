// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/library/sources/marker_source.h"
#include "app/library/sources/source_motion.h"
#include "core/base/result.h"

namespace marey::app {

/// Renders a recipe of `marey edit` and returns its motions; SourceMotion::body is their
/// name (edit_names()) if there are several. A recipe of labelled markers is rendered and
/// solved by solve_marker_source(). Annotations become labels by "recipe" and events.
/// Writes nothing. Errors: render_recipe()'s; solve_marker_source()'s.
[[nodiscard]] Result<std::vector<SourceMotion>> read_recipe_source(
    const std::filesystem::path& file, const MarkerSourceOptions& options = {});

}  // namespace marey::app
