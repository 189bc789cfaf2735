// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/bone_map.h"
#include "retarget/bones/found_bones.h"
#include "retarget/bones/joint_words.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {

/// Adds the bones that follow from limbs and head: hips, vertebrae, neck, shoulders,
/// toes, and a hand or foot whose named joint has a different parent. Bones that
/// `overrides` sets are not changed.
/// Precondition: both upper legs are found; `overrides` does not say that hips are
/// absent.
void complete_bones(const SkeletonTree& tree,
                    const std::vector<JointWord>& words,
                    const BoneMap& overrides,
                    FoundBones& found);

}  // namespace marey::retarget
