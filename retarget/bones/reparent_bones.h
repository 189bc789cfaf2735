// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// A body whose bones have the parents that a human body's have: feet below shins, thighs
/// below hips, arms and neck below the spine. Rest positions are the file's.
struct ReparentedBody {
  Skeleton skeleton;
  FoundBones found;
  /// For each joint, the joint of the file's skeleton that it comes from; nullopt for a
  /// joint that the file does not have.
  std::vector<std::optional<JointIndex>> read_joint;
};

/// Returns the nearest found bone that carries another one. Shoulders, arms and necks may
/// be below any vertebra, so for them it is the hips. nullopt for the hips.
[[nodiscard]] std::optional<HumanBone> carrier_of(const FoundBones& found,
                                                  HumanBone bone);

/// Moves bones that a file places elsewhere (below its root, below controls for inverse
/// kinematics, in another armature) below the bones that carry them. Any other joint that
/// is below neither the hips nor a bone is moved below the bone nearest at rest, if it
/// carries skin. A leg without a foot gets one: at the end of its shin if the file states
/// that position, otherwise as far below the knee as the knee is below the hip.
///
/// `carries_skin` is empty or holds for each joint whether vertices are bound to it.
/// Returns nullopt if nothing has to be moved.
/// Precondition: `found` passed the checks of identify_bones(). Errors (bad input): bones
/// that carry each other.
[[nodiscard]] Result<std::optional<ReparentedBody>> reparent_to_carriers(
    const Skeleton& skeleton,
    const FoundBones& found,
    const std::vector<bool>& carries_skin);

/// Converts the poses of the file's skeleton to the skeleton of `body`: joints keep their
/// world rotations, the root keeps its position. The pose of an added joint follows its
/// parent.
void convert_to_reparented(const ReparentedBody& body, Motion& motion);

}  // namespace marey::retarget
