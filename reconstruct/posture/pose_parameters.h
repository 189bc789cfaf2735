// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: names of a posture's unknowns and of a body's lengths, and
// their columns in a solver.

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "core/humanoid.h"

namespace marey::reconstruct {

/// The unknowns of a posture, one solver block each, in the order of Posture's storage.
enum class PoseParameter : int {
  kHipsPosition,  ///< 3 numbers, [m]
  // Rotations, 4 numbers (x, y, z, w).
  kHips,
  kAbdomenEnd,  ///< End of the abdomen's spline, start of the torso's.
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
  kLeftForearmTwist,  ///< Rotation of the lower bone about its own axis, out of the
                      ///< limb's plane.
  kRightForearmTwist,
  kLeftShankTwist,
  kRightShankTwist,
  kLeftUpperArmTwist,  ///< Twist of the upper bone: its skin follows it only half way.
  kRightUpperArmTwist,
  kLeftThighTwist,
  kRightThighTwist,
};
inline constexpr int kPoseParameterCount = 28;

[[nodiscard]] constexpr std::size_t index(PoseParameter parameter) {
  return static_cast<std::size_t>(parameter);
}
[[nodiscard]] constexpr bool is_rotation(PoseParameter parameter) {
  return parameter >= PoseParameter::kHips && parameter <= PoseParameter::kRightFoot;
}
[[nodiscard]] constexpr int block_size(PoseParameter parameter) {
  return parameter == PoseParameter::kHipsPosition ? 3 : (is_rotation(parameter) ? 4 : 1);
}
/// Returns the degrees of freedom of a block.
[[nodiscard]] constexpr int tangent_size(PoseParameter parameter) {
  return parameter == PoseParameter::kHipsPosition || is_rotation(parameter) ? 3 : 1;
}
[[nodiscard]] constexpr int storage_offset(PoseParameter parameter) {
  int offset = 0;
  for (int i = 0; i < static_cast<int>(parameter); ++i)
    offset += block_size(PoseParameter{i});
  return offset;
}
inline constexpr int kPostureStorage = 3 + 15 * 4 + 12;
inline constexpr int kPostureFreedom = 3 + 15 * 3 + 12;

inline constexpr std::array<PoseParameter, kPoseParameterCount> kAllPoseParameters = [] {
  std::array<PoseParameter, kPoseParameterCount> parameters{};
  for (int i = 0; i < kPoseParameterCount; ++i)
    parameters[static_cast<std::size_t>(i)] = PoseParameter{i};
  return parameters;
}();

/// The lengths that a subject's fit estimates. [m]
enum class Length : int {
  kSpine,  ///< Hips to spine joint; the next four are lengths to the next joint as well.
  kChest,
  kUpperChest,
  kNeck,
  kHead,
  kHalfHipWidth,  ///< The hips' X axis runs through both hip centres by definition.
  kShoulderOut,   ///< Pivot of the left clavicle in the rib cage's frame; the right
  kShoulderUp,    ///< one is its mirror image.
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

/// Parameters and lengths of a limb: one row per limb.
struct LimbParameters {
  PoseParameter frame;
  PoseParameter flexion;
  PoseParameter upper_twist;
  PoseParameter lower_twist;
  PoseParameter extremity;
  Length upper;
  Length lower;
};
/// In the order of human_limbs().
inline constexpr std::array<LimbParameters, 4> kLimbParameters{{
    {PoseParameter::kLeftArm,
     PoseParameter::kLeftElbow,
     PoseParameter::kLeftUpperArmTwist,
     PoseParameter::kLeftForearmTwist,
     PoseParameter::kLeftHand,
     Length::kLeftUpperArm,
     Length::kLeftLowerArm},
    {PoseParameter::kRightArm,
     PoseParameter::kRightElbow,
     PoseParameter::kRightUpperArmTwist,
     PoseParameter::kRightForearmTwist,
     PoseParameter::kRightHand,
     Length::kRightUpperArm,
     Length::kRightLowerArm},
    {PoseParameter::kLeftLeg,
     PoseParameter::kLeftKnee,
     PoseParameter::kLeftThighTwist,
     PoseParameter::kLeftShankTwist,
     PoseParameter::kLeftFoot,
     Length::kLeftUpperLeg,
     Length::kLeftLowerLeg},
    {PoseParameter::kRightLeg,
     PoseParameter::kRightKnee,
     PoseParameter::kRightThighTwist,
     PoseParameter::kRightShankTwist,
     PoseParameter::kRightFoot,
     Length::kRightUpperLeg,
     Length::kRightLowerLeg},
}};

/// Returns the limb's direction in the T-pose, root to end.
[[nodiscard]] inline glm::dvec3 limb_axis(std::size_t limb) {
  if (limb == 0) return {1, 0, 0};
  return limb == 1 ? glm::dvec3(-1, 0, 0) : glm::dvec3(0, -1, 0);
}

/// Number of a body's unknowns in a subject's fit: lengths, then three numbers per hinge.
inline constexpr int kShapeCount = kLengthCount + 12;
/// Returns the column of HingeShape::upper_rad of a limb; lower_rad and rollback_m are
/// next.
[[nodiscard]] constexpr int hinge_column(std::size_t limb) {
  return kLengthCount + 3 * static_cast<int>(limb);
}
/// Returns the axis that hinges are tilted about, in the T-pose: HingeShape's c.
[[nodiscard]] inline glm::dvec3 tilt_axis(std::size_t limb) {
  return {0, 0, limb % 2 == 0 ? 1.0 : -1.0};
}

/// Returns the parameters that a bone's frame in the world depends on, in order.
[[nodiscard]] std::vector<PoseParameter> parameters_of(HumanBone bone);

/// A bone's limb and its place there: 0 is the upper bone, 1 the lower, 2 hand or foot.
struct InLimb {
  std::size_t limb = 4;  ///< 4: no limb.
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
