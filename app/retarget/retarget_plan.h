// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/motion/motion_files.h"
#include "app/motion/read_body.h"
#include "app/retarget/retarget_arguments.h"
#include "core/base/result.h"

namespace marey::app {

/// Files that `marey retarget` writes.
struct RetargetPlan {
  struct Avatar {
    BodyFile file;
    std::string name;            ///< Prefix of the names of its results.
    std::filesystem::path stem;  ///< Without extension, in the folder of results.
  };
  std::vector<Avatar> avatars;
  std::vector<MotionFormat> formats;
  /// The user chose the formats: a body that cannot have one is reported.
  bool formats_are_wanted = false;
  std::filesystem::path file;  ///< The only result; empty: results go into a folder.
  std::filesystem::path page;  ///< The page of --report.

  /// Returns the path of the avatar's result in this format.
  [[nodiscard]] std::filesystem::path out(const Avatar& avatar,
                                          MotionFormat format) const;
};

/// Plans the results before anything is read. OUT is a file if there is one avatar, no
/// --formats, and the extension of a format. Otherwise it is a folder, in which results
/// are named after their avatars.
/// Errors (kBadInput): a file for several avatars, or with --formats; options without
/// effect; options for one avatar when there are several; two results of one name; a
/// result that would replace an input file.
/// Precondition: at least one avatar; formats and dialect are valid words.
[[nodiscard]] Result<RetargetPlan> plan_retarget(const RetargetArguments& args);

}  // namespace marey::app
