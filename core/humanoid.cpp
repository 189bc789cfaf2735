// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/humanoid.h"

#include <string>

namespace marey {
namespace {

using B = HumanBone;

struct BoneRow {
  B bone;
  std::string_view name;
  std::optional<B> parent;
  B mirrored;
};

constexpr std::array<BoneRow, kHumanBoneCount> kBones{{
    {B::kHips, "hips", std::nullopt, B::kHips},
    {B::kSpine, "spine", B::kHips, B::kSpine},
    {B::kChest, "chest", B::kSpine, B::kChest},
    {B::kUpperChest, "upperChest", B::kChest, B::kUpperChest},
    {B::kNeck, "neck", B::kUpperChest, B::kNeck},
    {B::kHead, "head", B::kNeck, B::kHead},
    {B::kLeftShoulder, "leftShoulder", B::kUpperChest, B::kRightShoulder},
    {B::kLeftUpperArm, "leftUpperArm", B::kLeftShoulder, B::kRightUpperArm},
    {B::kLeftLowerArm, "leftLowerArm", B::kLeftUpperArm, B::kRightLowerArm},
    {B::kLeftHand, "leftHand", B::kLeftLowerArm, B::kRightHand},
    {B::kRightShoulder, "rightShoulder", B::kUpperChest, B::kLeftShoulder},
    {B::kRightUpperArm, "rightUpperArm", B::kRightShoulder, B::kLeftUpperArm},
    {B::kRightLowerArm, "rightLowerArm", B::kRightUpperArm, B::kLeftLowerArm},
    {B::kRightHand, "rightHand", B::kRightLowerArm, B::kLeftHand},
    {B::kLeftUpperLeg, "leftUpperLeg", B::kHips, B::kRightUpperLeg},
    {B::kLeftLowerLeg, "leftLowerLeg", B::kLeftUpperLeg, B::kRightLowerLeg},
    {B::kLeftFoot, "leftFoot", B::kLeftLowerLeg, B::kRightFoot},
    {B::kLeftToes, "leftToes", B::kLeftFoot, B::kRightToes},
    {B::kRightUpperLeg, "rightUpperLeg", B::kHips, B::kLeftUpperLeg},
    {B::kRightLowerLeg, "rightLowerLeg", B::kRightUpperLeg, B::kLeftLowerLeg},
    {B::kRightFoot, "rightFoot", B::kRightLowerLeg, B::kLeftFoot},
    {B::kRightToes, "rightToes", B::kRightFoot, B::kLeftToes},
}};

}  // namespace

const std::array<HumanBone, kHumanBoneCount>& human_bones() {
  static const std::array<HumanBone, kHumanBoneCount> bones = [] {
    std::array<HumanBone, kHumanBoneCount> list{};
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = kBones[i].bone;
    return list;
  }();
  return bones;
}

std::string_view name(HumanBone bone) {
  return kBones[index(bone)].name;
}

std::optional<HumanBone> human_bone(std::string_view vrm_name) {
  for (const BoneRow& row : kBones) {
    if (row.name == vrm_name) return row.bone;
  }
  return std::nullopt;
}

std::optional<HumanBone> parent(HumanBone bone) {
  return kBones[index(bone)].parent;
}

HumanBone mirrored(HumanBone bone) {
  return kBones[index(bone)].mirrored;
}

const std::array<HumanLimb, 4>& human_limbs() {
  // Rest pose: T-pose facing +Z, left is +X. Elbows bend forward with the palms down,
  // knees bend backward.
  static const std::array<HumanLimb, 4> limbs{{
      {B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand, {0, -1, 0}},
      {B::kRightUpperArm, B::kRightLowerArm, B::kRightHand, {0, 1, 0}},
      {B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot, {1, 0, 0}},
      {B::kRightUpperLeg, B::kRightLowerLeg, B::kRightFoot, {1, 0, 0}},
  }};
  return limbs;
}

}  // namespace marey
