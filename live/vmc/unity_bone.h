// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/humanoid.h"

namespace marey::live {

/// Unity's HumanBodyBones, in Unity's order and with its numbers. VMC uses their names.
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

/// Returns Unity's name, such as "LeftUpperArm".
[[nodiscard]] std::string_view name(UnityBone bone);

/// Returns the bone with this name. Ignores case, because senders differ in it.
[[nodiscard]] std::optional<UnityBone> unity_bone(std::string_view unity_name);

/// Returns the Unity bone of a marey bone. Every marey bone has one.
[[nodiscard]] UnityBone unity_bone(HumanBone bone);

/// Returns the marey bone; nullopt for eyes, jaw and fingers.
[[nodiscard]] std::optional<HumanBone> human_bone(UnityBone bone);

/// Returns true for the 15 bones that VRM requires of a humanoid.
[[nodiscard]] bool is_required(HumanBone bone);

}  // namespace marey::live
