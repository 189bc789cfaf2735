// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "edit/markers/marker_state.h"

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::edit {

/// The result of a recipe, or of its first operations, on labelled markers.
struct RenderedMarkers {
  /// One recording, unless keep or split made several.
  std::vector<MarkerState> outputs;
  std::vector<OpReport>
      reports;  ///< One per operation and recording that it was applied to.
};

struct RenderMarkersOptions {
  std::optional<std::size_t> until{};  ///< Number of operations; nullopt: all.
  std::string recipe_file{};           ///< For the place of errors.
};

/// Applies the operations of a recipe, in their order, to the markers of its first
/// source, as render() does to a motion. Same recipe and markers, same result, to the
/// bit. `progress` receives the number of operations that are done.
/// Errors (bad input), with the recipe's file and the line: a limit of the recipe that
/// needs a body (slide_mm, constraint_mm); apply_marker_op()'s.
[[nodiscard]] Result<RenderedMarkers> render_markers(
    const EditRecipe& recipe,
    const MarkerState& source,
    const RenderMarkersOptions& options = {},
    const Progress& progress = {});

}  // namespace marey::edit
