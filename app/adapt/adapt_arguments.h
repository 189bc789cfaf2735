// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "retarget/adapt/adapter.h"

namespace marey::app {

/// Source of the supports (intervals in which a foot stands).
enum class SupportsFrom {
  kAuto,  ///< The constraints file; for feet without a support there, the motion.
  kFile,  ///< The constraints file alone.
  kNone,  ///< No supports; those of the file are ignored.
};

/// Arguments of `marey adapt`.
struct AdaptArguments {
  std::filesystem::path motion;
  std::filesystem::path character;    ///< character.toml; empty: the motion's own body.
  std::filesystem::path constraints;  ///< Empty: no constraints.
  std::filesystem::path out;          ///< .bvh or .glb
  /// nullopt: kFile if the file has supports, else kAuto.
  std::optional<SupportsFrom> supports;
  retarget::AdaptOptions options;
  std::vector<std::string> balance_groups;  ///< Empty: the character's own groups.
  std::vector<std::string> loads;           ///< Loads carried from the first frame on.
  std::filesystem::path floor;              ///< Uneven or moving floor; empty: level.
  double floor_height_m = 0.0;  ///< Height by which motion and floor are raised.
  bool json = false;
};

}  // namespace marey::app
