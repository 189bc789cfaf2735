// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/skeleton.h"

namespace marey::retarget {

/// Side of the body that a name contains.
enum class NameSide : unsigned char { kNone, kLeft, kRight };

/// A joint's name without the parts that programs add: "mixamorig:LeftUpLeg",
/// "DEF-upper_arm.L.001" and "lfemur" become left "upleg", left "upperarm1", left
/// "femur".
struct JointWord {
  std::string word;  ///< Lower case, numbers without leading zeros.
  NameSide side = NameSide::kNone;
};

/// Returns the words of all names. A prefix that most of the names share is removed.
[[nodiscard]] std::vector<JointWord> joint_words(const Skeleton& skeleton);

/// Returns true if a word names a part of the spine: "spine2", "chest", "lowerback".
[[nodiscard]] bool is_spine_word(std::string_view word);

}  // namespace marey::retarget
