// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/humanoid.h"

namespace marey::live {

/// Unity's HumanBodyBones, by whose names VMC calls bones; Unity's own order and numbers.
enum class UnityBone : int {
  kHips,
  kLeftUpperLeg,
  kRightUpperLeg,
  kLeftLowerLeg,
  kRightLowerLeg,
  kLeftFoot,
  kRightFoot,
  kSpine,
  kChest,
  kNeck,
  kHead,
  kLeftShoulder,
  kRightShoulder,
  kLeftUpperArm,
  kRightUpperArm,
  kLeftLowerArm,
  kRightLowerArm,
  kLeftHand,
  kRightHand,
  kLeftToes,
  kRightToes,
  kLeftEye,
  kRightEye,
  kJaw,
  kLeftThumbProximal,
  kLeftThumbIntermediate,
  kLeftThumbDistal,
  kLeftIndexProximal,
  kLeftIndexIntermediate,
  kLeftIndexDistal,
  kLeftMiddleProximal,
  kLeftMiddleIntermediate,
  kLeftMiddleDistal,
  kLeftRingProximal,
  kLeftRingIntermediate,
  kLeftRingDistal,
  kLeftLittleProximal,
  kLeftLittleIntermediate,
  kLeftLittleDistal,
  kRightThumbProximal,
  kRightThumbIntermediate,
  kRightThumbDistal,
  kRightIndexProximal,
  kRightIndexIntermediate,
  kRightIndexDistal,
  kRightMiddleProximal,
  kRightMiddleIntermediate,
  kRightMiddleDistal,
  kRightRingProximal,
  kRightRingIntermediate,
  kRightRingDistal,
  kRightLittleProximal,
  kRightLittleIntermediate,
  kRightLittleDistal,
  kUpperChest,
};

inline constexpr int kUnityBoneCount = 55;

[[nodiscard]] constexpr std::size_t index(UnityBone bone) {
  return static_cast<std::size_t>(bone);
}

/// Unity's name: "LeftUpperArm".
[[nodiscard]] std::string_view name(UnityBone bone);

/// The bone of this name, whatever the case of its letters: senders disagree about it.
[[nodiscard]] std::optional<UnityBone> unity_bone(std::string_view unity_name);

/// Unity's word for a bone of ours; every one has one.
[[nodiscard]] UnityBone unity_bone(HumanBone bone);

/// The bone of ours, if there is one: none of eyes, jaw and fingers.
[[nodiscard]] std::optional<HumanBone> human_bone(UnityBone bone);

/// Whether it is one of the 15 without which VRM calls no body a humanoid.
[[nodiscard]] bool is_required(HumanBone bone);

}  // namespace marey::live
