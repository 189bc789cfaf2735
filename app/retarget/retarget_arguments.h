// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/retarget/retarget_at_rate.h"

namespace marey::app {

/// What `marey retarget` was asked for.
struct RetargetArguments {
  std::filesystem::path motion;
  std::optional<std::filesystem::path> motion_bones;
  std::string neutral;  ///< Of the motion: read_neutral()'s word, or empty.
  std::vector<std::filesystem::path> avatars;
  std::vector<std::filesystem::path> more_avatars;  ///< Those of --avatar.
  std::optional<std::filesystem::path> bones;       ///< Of the only avatar.
  /// A file of one avatar, or a folder for all; see retarget_plan.h.
  std::filesystem::path out;
  std::vector<std::string> formats;  ///< Empty: .glb, .bvh and .vrma, as far as they go.
  std::string bvh_dialect;           ///< A BvhDialect's name, or empty.
  std::string clip = "motion";
  RetargetAtRateOptions options;
  bool balance = false;
  bool no_ground = false;
  bool no_hands = false;
  std::filesystem::path constraints_out;  ///< Empty: none.
  bool report = false;
  bool json = false;
};

}  // namespace marey::app
