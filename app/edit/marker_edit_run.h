// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "edit/markers/render_markers.h"

#include "app/edit/marker_edit_inputs.h"
#include "app/edit/marker_edit_outputs.h"
#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"
#include "core/finding.h"

namespace marey::app {

/// A recipe of labelled markers with its files, its result and the figures of it.
struct MarkerEditRun {
  EditRecipe recipe;
  MarkerEditFiles files;
  edit::RenderedMarkers rendered;
  std::vector<EditFigures> figures;
};

struct MarkerEditRunOptions {
  ReadEditOptions read;
  std::optional<std::size_t> until{};  ///< Number of operations; nullopt: all.
};

/// Reads and renders a recipe of labelled markers, and measures the result. Errors:
/// read_marker_edit_files()'s and render_markers()'s. Precondition: edits_markers().
[[nodiscard]] Result<MarkerEditRun> run_marker_edit(EditRecipe recipe,
                                                    const MarkerEditRunOptions& options,
                                                    const Progress& progress = {});

/// Returns the notes of the reader, the findings of the operations, what the files do not
/// hold of the source, and figures above their limit.
[[nodiscard]] std::vector<Finding> findings_of_marker_edit(const MarkerEditRun& run,
                                                           const EditOutput& output);

}  // namespace marey::app
