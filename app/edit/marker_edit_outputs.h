// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "edit/markers/render_markers.h"
#include <nlohmann/json_fwd.hpp>

#include "app/edit/edit_figures.h"
#include "app/edit/edit_outputs.h"
#include "app/edit/marker_edit_inputs.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"
#include "core/finding.h"

namespace marey::app {

/// Measures the results: frames, duration, displaced_mm (largest displacement by a
/// filter), acceleration_ratio (largest of a marker, over the source's) and
/// inferred_frames. The other figures need a body and are 0.
[[nodiscard]] std::vector<EditFigures> measure_marker_edit(
    const EditRecipe& recipe,
    const MarkerEditFiles& files,
    const edit::RenderedMarkers& rendered);

/// Returns what the files of the results do not hold of the source: analog channels,
/// force plates, points that are no markers, and events. A C3D keeps them if the frames
/// are consecutive whole frames of a C3D and the markers were not moved; a TRC holds
/// markers only.
[[nodiscard]] std::vector<Finding> assess_marker_content(
    const EditRecipe& recipe,
    const MarkerEditFiles& files,
    const edit::RenderedMarkers& rendered,
    const EditOutput& output);

/// Returns the content of NAME.edit.json (docs/formats/edit_recipe.md).
[[nodiscard]] nlohmann::ordered_json marker_edit_json(
    const EditRecipe& recipe,
    const MarkerEditFiles& files,
    const edit::RenderedMarkers& rendered,
    const std::vector<EditFigures>& figures);

/// Writes NAME.c3d and NAME.trc (or the formats of `output`), NAME.annotations.json and
/// NAME.edit.json. Each file appears whole or not at all; same input, same bytes. A TRC
/// of a C3D's markers has Y up, as readers assume; other files have the source's axes.
/// Events of the annotations become events of the C3D, at most 255. Returns the files.
/// Errors: the disk.
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_marker_edit(
    const EditRecipe& recipe,
    const MarkerEditFiles& files,
    const edit::RenderedMarkers& rendered,
    const std::vector<EditFigures>& figures,
    const EditOutput& output);

}  // namespace marey::app
