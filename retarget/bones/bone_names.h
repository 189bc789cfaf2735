// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/humanoid.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {

/// Bones found by name, in the naming scheme that explains most of the names. The spine's
/// named bones are hips, neck and head only; vertebrae are found by counting.
struct NamedBones {
  std::array<std::optional<JointIndex>, kHumanBoneCount> joints{};
  std::string_view scheme;  ///< "Mixamo"; empty if no bone is named.
  int legs = 0;             ///< Number of the legs' six bones that are named.
};

/// Finds bones by joint names. Errors (bad input): two joints have the name of one bone,
/// and neither is below the other.
[[nodiscard]] Result<NamedBones> name_bones(const SkeletonTree& tree);

}  // namespace marey::retarget
