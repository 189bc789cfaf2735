// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "core/humanoid.h"

namespace marey {

/// A joint of a published skeleton, and the bone that it is.
struct NamedBone {
  HumanBone bone;
  std::string_view name;
};

using NamedBones = std::array<NamedBone, kHumanBoneCount>;

/// The 22 body joints of SMPL and SMPL-H in their order (Loper et al. 2015). Parents come
/// first; the tree is that of human_bones().
inline constexpr NamedBones kSmplJoints{{
    {HumanBone::kHips, "pelvis"},
    {HumanBone::kLeftUpperLeg, "left_hip"},
    {HumanBone::kRightUpperLeg, "right_hip"},
    {HumanBone::kSpine, "spine1"},
    {HumanBone::kLeftLowerLeg, "left_knee"},
    {HumanBone::kRightLowerLeg, "right_knee"},
    {HumanBone::kChest, "spine2"},
    {HumanBone::kLeftFoot, "left_ankle"},
    {HumanBone::kRightFoot, "right_ankle"},
    {HumanBone::kUpperChest, "spine3"},
    {HumanBone::kLeftToes, "left_foot"},
    {HumanBone::kRightToes, "right_foot"},
    {HumanBone::kNeck, "neck"},
    {HumanBone::kLeftShoulder, "left_collar"},
    {HumanBone::kRightShoulder, "right_collar"},
    {HumanBone::kHead, "head"},
    {HumanBone::kLeftUpperArm, "left_shoulder"},
    {HumanBone::kRightUpperArm, "right_shoulder"},
    {HumanBone::kLeftLowerArm, "left_elbow"},
    {HumanBone::kRightLowerArm, "right_elbow"},
    {HumanBone::kLeftHand, "left_wrist"},
    {HumanBone::kRightHand, "right_wrist"},
}};

/// The 22 joints of LaFAN1's BVH files in their order (Harvey et al. 2020).
inline constexpr NamedBones kLafanJoints{{
    {HumanBone::kHips, "Hips"},
    {HumanBone::kLeftUpperLeg, "LeftUpLeg"},
    {HumanBone::kLeftLowerLeg, "LeftLeg"},
    {HumanBone::kLeftFoot, "LeftFoot"},
    {HumanBone::kLeftToes, "LeftToe"},
    {HumanBone::kRightUpperLeg, "RightUpLeg"},
    {HumanBone::kRightLowerLeg, "RightLeg"},
    {HumanBone::kRightFoot, "RightFoot"},
    {HumanBone::kRightToes, "RightToe"},
    {HumanBone::kSpine, "Spine"},
    {HumanBone::kChest, "Spine1"},
    {HumanBone::kUpperChest, "Spine2"},
    {HumanBone::kNeck, "Neck"},
    {HumanBone::kHead, "Head"},
    {HumanBone::kLeftShoulder, "LeftShoulder"},
    {HumanBone::kLeftUpperArm, "LeftArm"},
    {HumanBone::kLeftLowerArm, "LeftForeArm"},
    {HumanBone::kLeftHand, "LeftHand"},
    {HumanBone::kRightShoulder, "RightShoulder"},
    {HumanBone::kRightUpperArm, "RightArm"},
    {HumanBone::kRightLowerArm, "RightForeArm"},
    {HumanBone::kRightHand, "RightHand"},
}};

}  // namespace marey
