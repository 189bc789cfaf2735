// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/bone_map.h"
#include "retarget/bones/found_bones.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {

/// Returns the errors of identify_bones() that a complete set of bones can have.
[[nodiscard]] Status check_bones(const SkeletonTree& tree,
                                 const BoneMap& overrides,
                                 const FoundBones& found);

}  // namespace marey::retarget
