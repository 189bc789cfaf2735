// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "edit/state/op_report.h"

#include "app/edit/edit_source_file.h"
#include "app/motion/motion_files.h"
#include "app/motion/retarget_files.h"
#include "core/base/result.h"
#include "core/edit/edit_recipe.h"

namespace marey::app {

/// The files that a recipe names, read.
struct EditFiles {
  edit::EditInputs inputs;
  std::map<std::string, OpenedAvatar> avatars;  ///< By RetargetOp::avatar.
  std::vector<std::string>
      sha256;  ///< SHA-256 of each source's file, in the recipe's order.
  std::map<std::string, std::string> avatar_sha256;
  /// Peak acceleration of a joint in the first source. [m/s^2]
  double source_peak_m_per_s2 = 0.0;
  BodyLook look;  ///< Look of the first source's body: with its mesh, if it has one.
  /// Sources and avatars, and those of recipes among the sources.
  std::vector<std::filesystem::path> paths;
  std::vector<std::string> remarks;  ///< Assumptions of the readers, with the file.
};

/// Reads sources and avatars. A source is a motion file that `marey retarget` reads, a
/// trial's folder of results (its motion.npz, with the sigmas and sources of its frames)
/// or another recipe, which is rendered. A source that is not at its path is looked for
/// by its name in the recipe's folder.
/// Errors (bad input), with file and line of the recipe: a file that is missing or cannot
/// be read; content of another SHA-256 than recorded; recipes that are sources of each
/// other; labelled markers (.c3d, .trc); make_edit_state()'s.
[[nodiscard]] Result<EditFiles> read_edit_files(const EditRecipe& recipe,
                                                const ReadEditOptions& options);

/// Returns the key of each operation for edit::EditCache: the SHA-256 of its text, of
/// those before it, and of the files that they use.
[[nodiscard]] std::vector<std::string> edit_keys(const EditRecipe& recipe,
                                                 const EditFiles& files);

}  // namespace marey::app
