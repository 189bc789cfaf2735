// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/bone_map.h"
#include "core/result.h"
#include "retarget/bone_names.h"
#include "retarget/identify_bones.h"
#include "retarget/skeleton_tree.h"

namespace marey::retarget {

/// Adds what follows from limbs and head that are found: hips, vertebrae, neck,
/// shoulders, toes, an extremity whose named joint hangs elsewhere. Leaves alone what the
/// user told. Precondition: both upper legs are found, and hips are not told to be absent.
void complete_bones(const SkeletonTree& tree,
                    const std::vector<JointWord>& words,
                    const BoneMap& told,
                    FoundBones& found);

/// The errors of identify_bones() that a complete set of bones can have.
[[nodiscard]] Status check_bones(const SkeletonTree& tree,
                                 const BoneMap& told,
                                 const FoundBones& found);

}  // namespace marey::retarget
