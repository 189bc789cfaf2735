// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/humanoid.h"
#include "core/ids.h"
#include "core/result.h"
#include "retarget/skeleton_tree.h"

namespace marey::retarget {

/// Which side of the body a name says.
enum class NameSide : unsigned char { kNone, kLeft, kRight };

/// A joint's name without what programs put around it: "mixamorig:LeftUpLeg",
/// "DEF-upper_arm.L.001" and "lfemur" become left "upleg", left "upperarm1", left
/// "femur".
struct JointWord {
  std::string word;  ///< Lower case, numbers without leading zeros.
  NameSide side = NameSide::kNone;
};

/// The words of all names. What most of the names begin with is no part of them.
[[nodiscard]] std::vector<JointWord> joint_words(const Skeleton& skeleton);

/// Bones that the names tell, of the scheme that explains most of them. Bones of the
/// spine are told where it comes to hips, neck and head alone: vertebrae are counted, not
/// named.
struct NamedBones {
  std::array<std::optional<JointIndex>, kHumanBoneCount> joints{};
  std::string_view scheme;  ///< "Mixamo"; empty when nothing is named.
  int legs = 0;             ///< Of the six bones that both legs need.
};

/// Errors: two joints bear the name of one bone, and neither hangs on the other.
[[nodiscard]] Result<NamedBones> name_bones(const SkeletonTree& tree);

/// Whether a word is one of the spine's: "spine2", "chest", "lowerback".
[[nodiscard]] bool is_spine_word(std::string_view word);

}  // namespace marey::retarget
