// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the names of a posture's unknowns and of a body's lengths, and
// the columns that a solver gives them.

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "core/humanoid.h"

namespace marey::reconstruct {

/// The unknowns of a posture, one solver block each. Order is that of Posture's storage.
enum class Slot : int {
  kHipsPosition,  ///< 3 numbers, [m]
  // Rotations, 4 numbers (x, y, z, w).
  kHips,
  kAbdomenEnd,  ///< Where the abdomen's spline meets the torso's.
  kThorax,      ///< Upper end of the torso's spline: the rib cage.
  kNeck,
  kHead,
  kLeftShoulder,
  kRightShoulder,
  kLeftArm,  ///< The limb's frame.
  kRightArm,
  kLeftLeg,
  kRightLeg,
  kLeftHand,
  kRightHand,
  kLeftFoot,
  kRightFoot,
  // Scalars, [rad].
  kLeftElbow,  ///< Flexion: 0 is straight.
  kRightElbow,
  kLeftKnee,
  kRightKnee,
  kLeftForearmTwist,  ///< Of the lower bone about its own axis, off the limb's plane.
  kRightForearmTwist,
  kLeftShankTwist,
  kRightShankTwist,
  kLeftUpperArmTwist,  ///< Likewise of the upper bone: its skin follows it only half way.
  kRightUpperArmTwist,
  kLeftThighTwist,
  kRightThighTwist,
};
inline constexpr int kSlotCount = 28;

[[nodiscard]] constexpr std::size_t index(Slot slot) {
  return static_cast<std::size_t>(slot);
}
[[nodiscard]] constexpr bool is_rotation(Slot slot) {
  return slot >= Slot::kHips && slot <= Slot::kRightFoot;
}
[[nodiscard]] constexpr int block_size(Slot slot) {
  return slot == Slot::kHipsPosition ? 3 : (is_rotation(slot) ? 4 : 1);
}
/// Degrees of freedom of a block.
[[nodiscard]] constexpr int tangent_size(Slot slot) {
  return slot == Slot::kHipsPosition || is_rotation(slot) ? 3 : 1;
}
[[nodiscard]] constexpr int storage_offset(Slot slot) {
  int offset = 0;
  for (int i = 0; i < static_cast<int>(slot); ++i) offset += block_size(Slot{i});
  return offset;
}
inline constexpr int kPostureStorage = 3 + 15 * 4 + 12;
inline constexpr int kPostureFreedom = 3 + 15 * 3 + 12;

inline constexpr std::array<Slot, kSlotCount> kAllSlots = [] {
  std::array<Slot, kSlotCount> slots{};
  for (int i = 0; i < kSlotCount; ++i) slots[static_cast<std::size_t>(i)] = Slot{i};
  return slots;
}();

/// The lengths that a subject's fit moves. [m]
enum class Length : int {
  kSpine,  ///< hips to spine joint; likewise the next four.
  kChest,
  kUpperChest,
  kNeck,
  kHead,
  kHalfHipWidth,  ///< The hips' X axis runs through both hip centres by definition.
  kShoulderOut,   ///< Where the left clavicle turns, in the rib cage's frame; the right
  kShoulderUp,    ///< one mirrors it.
  kShoulderForward,
  kNeckForward,
  kLeftShoulder,  ///< Inner to outer end of the clavicle.
  kRightShoulder,
  kLeftUpperArm,
  kRightUpperArm,
  kLeftLowerArm,
  kRightLowerArm,
  kLeftUpperLeg,
  kRightUpperLeg,
  kLeftLowerLeg,
  kRightLowerLeg,
};
inline constexpr int kLengthCount = 20;
using Lengths = std::array<double, kLengthCount>;

[[nodiscard]] constexpr std::size_t index(Length length) {
  return static_cast<std::size_t>(length);
}

/// How the posture's numbers make bones: one row per limb.
struct LimbSlots {
  Slot frame;
  Slot flexion;
  Slot upper_twist;
  Slot lower_twist;
  Slot extremity;
  Length upper;
  Length lower;
};
/// In the order of human_limbs().
inline constexpr std::array<LimbSlots, 4> kLimbSlots{{
    {Slot::kLeftArm,
     Slot::kLeftElbow,
     Slot::kLeftUpperArmTwist,
     Slot::kLeftForearmTwist,
     Slot::kLeftHand,
     Length::kLeftUpperArm,
     Length::kLeftLowerArm},
    {Slot::kRightArm,
     Slot::kRightElbow,
     Slot::kRightUpperArmTwist,
     Slot::kRightForearmTwist,
     Slot::kRightHand,
     Length::kRightUpperArm,
     Length::kRightLowerArm},
    {Slot::kLeftLeg,
     Slot::kLeftKnee,
     Slot::kLeftThighTwist,
     Slot::kLeftShankTwist,
     Slot::kLeftFoot,
     Length::kLeftUpperLeg,
     Length::kLeftLowerLeg},
    {Slot::kRightLeg,
     Slot::kRightKnee,
     Slot::kRightThighTwist,
     Slot::kRightShankTwist,
     Slot::kRightFoot,
     Length::kRightUpperLeg,
     Length::kRightLowerLeg},
}};

/// The limb's direction in the T-pose, root to end.
[[nodiscard]] inline glm::dvec3 limb_axis(std::size_t limb) {
  if (limb == 0) return {1, 0, 0};
  return limb == 1 ? glm::dvec3(-1, 0, 0) : glm::dvec3(0, -1, 0);
}

/// What a subject's fit moves of a body: lengths, then three numbers of each hinge.
inline constexpr int kShapeCount = kLengthCount + 12;
/// The column of HingeShape::upper_rad of a limb; lower_rad and rollback_m are next.
[[nodiscard]] constexpr int hinge_column(std::size_t limb) {
  return kLengthCount + 3 * static_cast<int>(limb);
}
/// The axis that hinges are tilted about, in the T-pose: HingeShape's c.
[[nodiscard]] inline glm::dvec3 tilt_axis(std::size_t limb) {
  return {0, 0, limb % 2 == 0 ? 1.0 : -1.0};
}

/// The slots that a bone's frame in the world depends on, in slot order.
[[nodiscard]] std::vector<Slot> slots_of(HumanBone bone);

/// Which bone of which limb: place 0 is the upper bone, 1 the lower, 2 hand or foot.
struct InLimb {
  std::size_t limb = 4;  ///< 4: in none.
  int place = 0;
};

[[nodiscard]] constexpr InLimb in_limb(HumanBone bone) {
  switch (bone) {
    case HumanBone::kLeftUpperArm:
      return {0, 0};
    case HumanBone::kLeftLowerArm:
      return {0, 1};
    case HumanBone::kLeftHand:
      return {0, 2};
    case HumanBone::kRightUpperArm:
      return {1, 0};
    case HumanBone::kRightLowerArm:
      return {1, 1};
    case HumanBone::kRightHand:
      return {1, 2};
    case HumanBone::kLeftUpperLeg:
      return {2, 0};
    case HumanBone::kLeftLowerLeg:
      return {2, 1};
    case HumanBone::kLeftFoot:
    case HumanBone::kLeftToes:
      return {2, 2};
    case HumanBone::kRightUpperLeg:
      return {3, 0};
    case HumanBone::kRightLowerLeg:
      return {3, 1};
    case HumanBone::kRightFoot:
    case HumanBone::kRightToes:
      return {3, 2};
    default:
      return {};
  }
}

}  // namespace marey::reconstruct
