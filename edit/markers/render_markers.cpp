// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/render_markers.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "edit/markers/apply_marker_op.h"
#include "edit/state/op_error.h"

namespace marey::edit {
namespace {

Status check_marker_limits(const EditLimits& limits, const std::string& recipe_file) {
  const char* key = nullptr;
  if (limits.slide_mm) key = "slide_mm";
  if (limits.constraint_mm) key = "constraint_mm";
  if (key == nullptr) return Done{};
  return bad_input(
      recipe_file.empty() ? "[limits]" : recipe_file + ": [limits]",
      std::string(key) + " cannot be measured on labelled markers: it needs a body",
      "remove it; displaced_mm and acceleration_ratio can be measured");
}

}  // namespace

Result<RenderedMarkers> render_markers(const EditRecipe& recipe,
                                       const MarkerState& source,
                                       const RenderMarkersOptions& options,
                                       const Progress& progress) {
  const Status limits = check_marker_limits(recipe.limits, options.recipe_file);
  if (!limits) return limits.error();
  const std::size_t count =
      std::min(options.until.value_or(recipe.ops.size()), recipe.ops.size());
  RenderedMarkers out;
  out.outputs.push_back(source);
  for (std::size_t i = 0; i < count; ++i) {
    const EditOp& op = recipe.ops[i];
    std::vector<MarkerState> made;
    for (MarkerState& state : out.outputs) {
      if (op.off) {
        made.push_back(std::move(state));
        continue;
      }
      OpReport report;
      auto parts = apply_marker_op({op, static_cast<int>(i)}, state, report);
      if (!parts) return at_recipe_line(parts.error(), op, i, options.recipe_file);
      out.reports.push_back(std::move(report));
      std::move(parts->begin(), parts->end(), std::back_inserter(made));
    }
    out.outputs = std::move(made);
    if (progress) progress(static_cast<int>(i + 1), static_cast<int>(count));
  }
  return out;
}

}  // namespace marey::edit
