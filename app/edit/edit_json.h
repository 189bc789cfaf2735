// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "edit/render.h"
#include <nlohmann/json_fwd.hpp>

#include "app/edit/edit_figures.h"
#include "app/edit/edit_inputs.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

/// Returns the content of NAME.edit.json: sources, operations with their figures and
/// findings, and for each result its figures and the origin of its frames
/// (docs/formats/edit_recipe.md).
[[nodiscard]] nlohmann::ordered_json edit_json(const EditRecipe& recipe,
                                               const EditFiles& files,
                                               const edit::Rendered& rendered,
                                               const std::vector<EditFigures>& figures);

/// Returns the figures of one result.
[[nodiscard]] nlohmann::ordered_json edit_figures_json(const EditFigures& figures);
/// Returns frames of the same origin as runs.
[[nodiscard]] nlohmann::ordered_json edit_lineage_json(const edit::Lineage& lineage);
/// Returns the figures and findings of one operation.
[[nodiscard]] nlohmann::ordered_json edit_report_json(const edit::OpReport& report);

}  // namespace marey::app
