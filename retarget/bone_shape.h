// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/result.h"
#include "retarget/identify_bones.h"
#include "retarget/skeleton_tree.h"

namespace marey::retarget {

/// Bones by the shape of the tree: limbs, hips, head, the way between them not yet. Which
/// leg is the left one is a guess until is known where the body looks; its confidence is
/// how alike the sides are.
/// Errors: no joint with two like branches, or none above it.
[[nodiscard]] Result<FoundBones> shape_bones(const SkeletonTree& tree);

/// The three joints of a limb on the way down a branch: those that leave the longest
/// bones whose ratio is near to `upper_over_lower`. nullopt for less than three joints.
struct LimbJoints {
  JointIndex upper{};
  JointIndex lower{};
  JointIndex end{};
};
[[nodiscard]] std::optional<LimbJoints> limb_joints(const SkeletonTree& tree,
                                                    const std::vector<JointIndex>& way,
                                                    double upper_over_lower);

/// The head above a chest that carries these arms: where the longest of the other
/// branches leads, past one joint of neck. nullopt when there is no other.
[[nodiscard]] std::optional<JointIndex> head_above(const SkeletonTree& tree,
                                                   JointIndex chest,
                                                   std::span<const JointIndex> arms);

}  // namespace marey::retarget
