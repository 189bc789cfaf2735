// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edit/render.h"

#include "app/edit/edit_figures.h"
#include "app/edit/edit_inputs.h"
#include "app/motion/motion_files.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"
#include "core/finding.h"

namespace marey::app {

/// Kinds of files for labelled markers.
enum class MarkerFormat { kC3d, kTrc };
/// Returns the file extension without its point: "c3d".
[[nodiscard]] constexpr std::string_view name(MarkerFormat format) {
  return format == MarkerFormat::kC3d ? "c3d" : "trc";
}

struct EditOutput {
  std::filesystem::path out;          ///< Folder.
  std::vector<MotionFormat> formats;  ///< Empty: all formats that the body allows.
  std::vector<MarkerFormat> marker_formats{};  ///< Empty: both, for labelled markers.
  /// Files that results must not overwrite, besides those that the recipe reads.
  std::vector<std::filesystem::path> kept{};
};

/// Checks that formats were not given for the other kind of data only. Errors (usage).
[[nodiscard]] Status check_output_formats(const EditOutput& output, bool has_markers);

/// Checks that no result overwrites a file that was read or must be kept. `endings` are
/// those of the results' files: ".npz". Errors (bad input): a result would overwrite one.
[[nodiscard]] Status check_no_overwrite(const EditOutput& output,
                                        const std::vector<std::filesystem::path>& read,
                                        const std::vector<std::string>& names,
                                        const std::vector<std::string>& endings);

/// Returns the names of the results: that of the recipe, with .1, .2 ... if there are
/// several.
[[nodiscard]] std::vector<std::string> edit_names(const EditRecipe& recipe,
                                                  std::size_t outputs);

[[nodiscard]] std::vector<EditFigures> measure_edit(const EditRecipe& recipe,
                                                    const EditFiles& files,
                                                    const edit::Rendered& rendered);

/// Returns a poor finding for each figure above its limit in the recipe.
[[nodiscard]] std::vector<Finding> assess_edit(const EditRecipe& recipe,
                                               const std::vector<EditFigures>& figures);

/// Checks that the motion of a result can be written in a format: as can_hold(), and a
/// skeleton made by marey without a mesh has a mannequin in a .glb.
[[nodiscard]] Status check_result_format(MotionFormat format,
                                         const edit::EditState& state,
                                         const BodyLook& look);
/// Writes the motion of a result, an .npz with its uncertainty and contacts. The file
/// appears whole or not at all; same input, same bytes.
/// Errors: check_result_format()'s, with `path`; the disk.
[[nodiscard]] Status write_result_motion(const std::filesystem::path& path,
                                         MotionFormat format,
                                         const edit::EditState& state,
                                         const BodyLook& look);

/// Writes NAME.npz, .bvh, .glb and .vrma (what the body allows), NAME.constraints.xml if
/// there are any, NAME.annotations.json and NAME.edit.json. Each file appears whole or
/// not at all; same input, same bytes. Returns the files.
/// Errors: the disk; check_no_overwrite()'s, before anything is written.
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_edit(
    const EditRecipe& recipe,
    const EditFiles& files,
    const edit::Rendered& rendered,
    const std::vector<EditFigures>& figures,
    const EditOutput& output);

}  // namespace marey::app
