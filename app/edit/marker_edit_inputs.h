// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "edit/markers/marker_state.h"

#include "app/edit/edit_source_file.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"
#include "recordings/markers/labelled_markers.h"

namespace marey::app {

/// An event of a C3D, and the text of its annotation.
struct MarkerEditEvent {
  std::string text;
  recordings::MarkerEvent event;
};

/// Content of a C3D that is not markers or events.
struct OtherC3dContent {
  int analog_channels = 0;
  int force_plates = 0;
  int points = 0;  ///< Points that are no markers, such as computed angles.

  [[nodiscard]] bool is_empty() const {
    return analog_channels == 0 && force_plates == 0 && points == 0;
  }
};

/// The markers that a recipe edits, read.
struct MarkerEditFiles {
  edit::MarkerState source;
  std::string sha256;  ///< SHA-256 of the source's file, and of files below it.
  recordings::FileAxes axes;
  std::vector<MarkerEditEvent> events;  ///< Events of the source, in its order.
  bool is_from_c3d = false;             ///< The markers were read from a C3D.
  OtherC3dContent other;
  /// The C3D of which a result can keep the other content; nullopt: the source is
  /// a TRC or another recipe.
  std::optional<std::filesystem::path> c3d;
  /// The source, and that of a recipe which is the source.
  std::vector<std::filesystem::path> paths;
  std::vector<std::string> remarks;  ///< Notes of the reader, with the file.
};

/// Returns true if a recipe edits labelled markers: its first source is a .c3d or .trc,
/// or a recipe that edits markers. False if that cannot be found out.
[[nodiscard]] bool edits_markers(const EditRecipe& recipe,
                                 const ReadEditOptions& options);

/// Reads the markers of a recipe. Events of a C3D become annotations: a foot strike or
/// foot off with its side becomes left.strike, left.toe_off, right.strike or
/// right.toe_off, others "Left Label". With several subjects, the subject's name and a
/// colon come first. Events outside the frames are left out, with a remark. If the source
/// is another recipe, it is rendered.
/// Errors (bad input), with file and line of the recipe: a file that is missing or cannot
/// be read; content of another SHA-256 than recorded; more than one source;
/// make_marker_state()'s. Precondition: edits_markers().
[[nodiscard]] Result<MarkerEditFiles> read_marker_edit_files(
    const EditRecipe& recipe, const ReadEditOptions& options);

}  // namespace marey::app
