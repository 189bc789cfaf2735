// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "core/base/in_quotes.h"

namespace marey {

/// The bones of VRM's humanoid that marey solves. A bone is named after the joint at its
/// near end: kLeftLowerArm is the forearm, its origin the elbow. Parents come first.
enum class HumanBone : int {
  kHips,
  kSpine,
  kChest,
  kUpperChest,
  kNeck,
  kHead,
  kLeftShoulder,
  kLeftUpperArm,
  kLeftLowerArm,
  kLeftHand,
  kRightShoulder,
  kRightUpperArm,
  kRightLowerArm,
  kRightHand,
  kLeftUpperLeg,
  kLeftLowerLeg,
  kLeftFoot,
  kLeftToes,
  kRightUpperLeg,
  kRightLowerLeg,
  kRightFoot,
  kRightToes,
};

inline constexpr int kHumanBoneCount = 22;

[[nodiscard]] constexpr std::size_t index(HumanBone bone) {
  return static_cast<std::size_t>(bone);
}

/// Every bone, parents before children.
[[nodiscard]] const std::array<HumanBone, kHumanBoneCount>& human_bones();

/// Returns VRM's name: "leftUpperArm".
[[nodiscard]] std::string_view name(HumanBone bone);

/// Returns the bone's name in quotation marks, for a message.
[[nodiscard]] inline std::string in_quotes(HumanBone bone) {
  return in_quotes(name(bone));
}

/// Returns the bone with VRM's name `vrm_name` (case-sensitive), if marey has it.
[[nodiscard]] std::optional<HumanBone> human_bone(std::string_view vrm_name);

/// Returns the parent bone; nullopt for the hips.
[[nodiscard]] std::optional<HumanBone> parent(HumanBone bone);

/// Returns the same bone on the other side; the bone itself in the middle of the body.
[[nodiscard]] HumanBone mirrored(HumanBone bone);

/// A limb of the normalized skeleton (Kulpa 2005, 1.1.2): two bones and an extremity.
struct HumanLimb {
  HumanBone upper;
  HumanBone lower;
  HumanBone end;
  /// Unit axis, in the upper bone's rest frame, about which a positive angle bends the
  /// limb the natural way. It is perpendicular to the straight limb.
  glm::dvec3 hinge_axis;
};

/// Returns left arm, right arm, left leg, right leg.
[[nodiscard]] const std::array<HumanLimb, 4>& human_limbs();

}  // namespace marey
