// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/retarget/retarget_at_rate.h"

namespace marey::app {

/// Arguments of `marey retarget`.
struct RetargetArguments {
  std::filesystem::path motion;
  std::optional<std::filesystem::path> motion_bones;
  std::string neutral;  ///< Neutral of the motion, for read_neutral(), or empty.
  std::vector<std::filesystem::path> avatars;
  std::vector<std::filesystem::path> more_avatars;  ///< Given with --avatar.
  std::optional<std::filesystem::path> bones;       ///< Bone map of a single avatar.
  /// A file for one avatar, or a folder for several; see retarget_plan.h.
  std::filesystem::path out;
  std::vector<std::string> formats;  ///< Empty: those of .glb, .bvh and .vrma that fit.
  std::string bvh_dialect;           ///< A BvhDialect's name, or empty.
  std::string clip = "motion";
  RetargetAtRateOptions options;
  bool balance = false;
  bool no_ground = false;
  bool no_hands = false;
  std::filesystem::path constraints_out;  ///< Empty: not written.
  bool report = false;
  bool json = false;
};

}  // namespace marey::app
