// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/unity_bone.h"

#include <algorithm>
#include <array>

#include "core/base/lower_case.h"

namespace marey::live {
namespace {

constexpr std::array<std::string_view, kUnityBoneCount> kNames{
    "Hips",
    "LeftUpperLeg",
    "RightUpperLeg",
    "LeftLowerLeg",
    "RightLowerLeg",
    "LeftFoot",
    "RightFoot",
    "Spine",
    "Chest",
    "Neck",
    "Head",
    "LeftShoulder",
    "RightShoulder",
    "LeftUpperArm",
    "RightUpperArm",
    "LeftLowerArm",
    "RightLowerArm",
    "LeftHand",
    "RightHand",
    "LeftToes",
    "RightToes",
    "LeftEye",
    "RightEye",
    "Jaw",
    "LeftThumbProximal",
    "LeftThumbIntermediate",
    "LeftThumbDistal",
    "LeftIndexProximal",
    "LeftIndexIntermediate",
    "LeftIndexDistal",
    "LeftMiddleProximal",
    "LeftMiddleIntermediate",
    "LeftMiddleDistal",
    "LeftRingProximal",
    "LeftRingIntermediate",
    "LeftRingDistal",
    "LeftLittleProximal",
    "LeftLittleIntermediate",
    "LeftLittleDistal",
    "RightThumbProximal",
    "RightThumbIntermediate",
    "RightThumbDistal",
    "RightIndexProximal",
    "RightIndexIntermediate",
    "RightIndexDistal",
    "RightMiddleProximal",
    "RightMiddleIntermediate",
    "RightMiddleDistal",
    "RightRingProximal",
    "RightRingIntermediate",
    "RightRingDistal",
    "RightLittleProximal",
    "RightLittleIntermediate",
    "RightLittleDistal",
    "UpperChest",
};

bool same_letters(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](char one, char other) { return lower_case(one) == lower_case(other); });
}

/// Tables of both directions, built from the names: VRM's and Unity's differ only in
/// case.
struct Words {
  std::array<UnityBone, kHumanBoneCount> unity{};
  std::array<std::optional<HumanBone>, kUnityBoneCount> human{};
};

Words make_words() {
  Words words;
  for (const HumanBone bone : human_bones()) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      if (!same_letters(kNames[i], marey::name(bone))) continue;
      words.unity[index(bone)] = static_cast<UnityBone>(i);
      words.human[i] = bone;
    }
  }
  return words;
}

const Words& words() {
  static const Words table = make_words();
  return table;
}

}  // namespace

std::string_view name(UnityBone bone) {
  return kNames[index(bone)];
}

std::optional<UnityBone> unity_bone(std::string_view unity_name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (same_letters(kNames[i], unity_name)) return static_cast<UnityBone>(i);
  }
  return std::nullopt;
}

UnityBone unity_bone(HumanBone bone) {
  return words().unity[index(bone)];
}

std::optional<HumanBone> human_bone(UnityBone bone) {
  return words().human[index(bone)];
}

bool is_required(HumanBone bone) {
  switch (bone) {
    case HumanBone::kChest:
    case HumanBone::kUpperChest:
    case HumanBone::kNeck:
    case HumanBone::kLeftShoulder:
    case HumanBone::kRightShoulder:
    case HumanBone::kLeftToes:
    case HumanBone::kRightToes:
      return false;
    default:
      return true;
  }
}

}  // namespace marey::live
