// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "retarget/bones/found_bones.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {

/// Finds bones by the shape of the tree: limbs, hips and head; the vertebrae between them
/// are not found here. Which leg is left is a guess until the front of the body is known;
/// its confidence is the similarity of the sides. Errors (bad input): no joint with two
/// similar branches, or none above it.
[[nodiscard]] Result<FoundBones> shape_bones(const SkeletonTree& tree);

/// Returns the three joints of a limb along a branch: those with the longest bones whose
/// length ratio is near `upper_over_lower`. nullopt for fewer than three joints.
struct LimbJoints {
  JointIndex upper{};
  JointIndex lower{};
  JointIndex end{};
};
[[nodiscard]] std::optional<LimbJoints> limb_joints(const SkeletonTree& tree,
                                                    const std::vector<JointIndex>& way,
                                                    double upper_over_lower);

/// Returns the head above a chest that carries these arms: the joint after one neck joint
/// on the longest of the other branches. nullopt if there is no other branch.
[[nodiscard]] std::optional<JointIndex> head_above(const SkeletonTree& tree,
                                                   JointIndex chest,
                                                   std::span<const JointIndex> arms);

}  // namespace marey::retarget
