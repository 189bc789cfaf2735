// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/motion.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "retarget/identify_bones.h"

namespace marey::retarget {

/// A body whose bones hang on each other as a body's do: feet on shins, thighs on hips,
/// arms and neck on the spine. Places at rest are the file's.
struct HungBody {
  Skeleton skeleton;
  FoundBones found;
  /// The joint of the file's skeleton that each joint is; nullopt for a joint that the
  /// file does not have.
  std::vector<std::optional<JointIndex>> read_joint;
};

/// The bone that carries another: the nearest one above it that is found. Shoulders, arms
/// and necks may hang on any vertebra, so that theirs is the hips. nullopt for the hips.
[[nodiscard]] std::optional<HumanBone> carrier_of(const FoundBones& found,
                                                  HumanBone bone);

/// Hangs the bones that a file hangs elsewhere (on its root, on controls for inverse
/// kinematics, on another armature) on the bones that carry them. What else is below
/// neither the hips nor a bone goes to the nearest bone at rest, if it carries skin. A
/// leg without a foot gets one: at the end of its shin, where the file says where that
/// is, else as far below the knee as that is below the hip.
///
/// `carries_skin` is empty or says of each joint whether vertices hang on it. nullopt
/// when there is nothing to hang. Precondition: `found` passed the checks of
/// identify_bones(). Errors (bad input): bones that carry each other.
[[nodiscard]] Result<std::optional<HungBody>> hang_bones(
    const Skeleton& skeleton,
    const FoundBones& found,
    const std::vector<bool>& carries_skin);

/// The poses of the file's skeleton on the hung one: joints keep their world rotations,
/// the root its place. Poses of a made joint follow its parent.
void put_on_hung(const HungBody& body, Motion& motion);

}  // namespace marey::retarget
