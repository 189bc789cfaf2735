// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "core/bone_map.h"
#include "core/skeleton.h"
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// Identifies the joint of each bone of a skeleton.
///
/// Marks in the file (Joint::bone) are used if hips and both legs are marked; no other
/// bones are searched then. `overrides` has priority over marks. Otherwise names are read
/// in the scheme that explains most of the legs and then most of all bones, regardless of
/// namespaces, side prefixes or suffixes, capitals and separators. If names do not
/// explain both legs, the shape decides: the legs are two similar branches of one joint,
/// the arms two others of a joint above it, which mostly also carries a head.
///
/// Hips are the deepest joint that carries both legs and the spine, whichever joint has
/// their name. The vertebrae from there to the neck become spine; spine and chest; spine,
/// chest and upperChest. If there are more than three, the lowest, the highest and,
/// between them, the one nearest to an average chest are used. A joint between the
/// vertebrae and an upper arm is a shoulder; a joint that continues a foot is its toes.
/// Twist and helper joints get no bone.
///
/// Errors (bad input), with the joint: no two legs; two joints of one name; bones whose
/// parents are not those of a body; limbs of zero or very different lengths. Cost: linear
/// in joints, except for shapes, which compare at most 48 pairs of branches.
[[nodiscard]] Result<FoundBones> identify_bones(const Skeleton& skeleton,
                                                const BoneMap& overrides = {});

/// Returns the bones that identify_bones() found before it rejected a body, for the user
/// to correct. Nothing is checked; bones may be missing.
[[nodiscard]] FoundBones guess_bones(const Skeleton& skeleton,
                                     const BoneMap& overrides = {});

/// Sets Joint::bone of every joint, or clears it.
void mark(const FoundBones& found, Skeleton& skeleton);

}  // namespace marey::retarget
