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

/// Which files `marey retarget` is to write.
struct RetargetPlan {
  struct Avatar {
    BodyFile file;
    std::string name;            ///< Its results' names begin with this.
    std::filesystem::path stem;  ///< Without extension, in the folder of results.
  };
  std::vector<Avatar> avatars;
  std::vector<MotionFormat> formats;
  /// The formats were asked for: a body that cannot have one is to be told of.
  bool formats_are_wanted = false;
  std::filesystem::path file;  ///< The only result; empty: a folder's worth of them.
  std::filesystem::path page;  ///< Of --report.

  [[nodiscard]] std::filesystem::path out(const Avatar& avatar,
                                          MotionFormat format) const;
};

/// Before anything is read. OUT is a file when there is one avatar, no --formats, and a
/// format's extension; else a folder, where results are named after their avatars.
/// Errors (kBadInput): a file for several avatars, or with --formats; options that have
/// nothing to say, or are of one avatar where there are several; two results of one name;
/// a result that would replace something that is read.
/// Precondition: there is an avatar; formats and dialect are words that there are.
[[nodiscard]] Result<RetargetPlan> plan_retarget(const RetargetArguments& args);

}  // namespace marey::app
