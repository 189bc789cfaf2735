// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "edit/markers/render_markers.h"
#include "edit/render.h"

#include "core/edit/edit_recipe.h"

namespace marey::app {

/// The largest distance between the same joint of two motions at the same frame.
struct MotionDifference {
  double largest_mm = 0.0;
  std::string joint;
  int frame = 0;
};

struct EditDifference {
  /// Operations that only one recipe has: "- " those of the first, "+ " those of the
  /// second, each as one line, in the order of the recipes.
  std::vector<std::string> operations;
  int first_frames = 0;
  int second_frames = 0;
  /// nullopt: the results are of different skeletons, or of several motions.
  std::optional<MotionDifference> motion;
};

/// Compares two recipes and their results. Compares the frames that both have.
[[nodiscard]] EditDifference compare_edits(const EditRecipe& first,
                                           const edit::Rendered& first_result,
                                           const EditRecipe& second,
                                           const edit::Rendered& second_result);

/// The largest distance between the same marker of two results at the same frame.
struct MarkerDifference {
  double largest_mm = 0.0;
  std::string marker;
  int frame = 0;
  std::size_t seen_in_one = 0;  ///< Samples that only one result has.
};

struct MarkerEditDifference {
  std::vector<std::string> operations;  ///< As EditDifference's.
  int first_frames = 0;
  int second_frames = 0;
  /// nullopt: the results have no marker in common, or several recordings.
  std::optional<MarkerDifference> markers;
};

/// Compares two recipes of labelled markers. Compares the frames and labels that both
/// have.
[[nodiscard]] MarkerEditDifference compare_marker_edits(
    const EditRecipe& first,
    const edit::RenderedMarkers& first_result,
    const EditRecipe& second,
    const edit::RenderedMarkers& second_result);

}  // namespace marey::app
