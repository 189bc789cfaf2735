// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "retarget/adapt/adapter.h"

namespace marey::app {

/// Which feet stand, and who says when.
enum class SupportsFrom {
  kAuto,  ///< The file; feet that it says nothing of: where the motion has them standing.
  kFile,  ///< The constraints file alone.
  kNone,  ///< None at all; those of the file are left out.
};

/// What `marey adapt` was asked for.
struct AdaptArguments {
  std::filesystem::path motion;
  std::filesystem::path character;    ///< character.toml; empty: the motion's own body.
  std::filesystem::path constraints;  ///< Empty: none.
  std::filesystem::path out;          ///< .bvh or .glb
  /// nullopt: the file's when it has any, else as kAuto.
  std::optional<SupportsFrom> supports;
  retarget::AdaptOptions options;
  std::vector<std::string> balance_groups;  ///< Empty: the character's own.
  std::vector<std::string> loads;           ///< Carried from the beginning.
  std::filesystem::path floor;              ///< Uneven or moving; empty: level.
  double floor_height_m = 0.0;  ///< By how much the motion and its floor are raised.
  bool json = false;
};

}  // namespace marey::app
