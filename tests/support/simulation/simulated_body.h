// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {

/// The frame of every bone in the world, by HumanBone. Axes are parallel to the world's
/// in the T-pose.
using BoneFrames = std::array<RigidTransform, kHumanBoneCount>;

/// A joint angle of an Attitude. The trunk and the head have three each, limbs have seven
/// (LimbAngle).
enum class Angle : int {
  kFloorX,   ///< X of the hips on the floor. [m]
  kFloorZ,   ///< Z of the hips on the floor. [m]
  kHeading,  ///< About Y; 0 faces +Z, positive turns towards +X.
  kHipsTilt,
  kHipsList,
  kTrunkX,  ///< Rotation vector of the rib cage in the hips' frame.
  kTrunkY,
  kTrunkZ,
  kHeadX,  ///< Rotation vector of the head in the rib cage's frame.
  kHeadY,
  kHeadZ,
  kFirstOfLimbs,
};

/// The angles of one limb. Positive is alike on both sides of the body.
enum class LimbAngle : int {
  kRaise,  ///< Sideways, away from the body; 0 hangs down.
  kSwing,  ///< Forward.
  kSpin,   ///< About the upper bone.
  kBend,   ///< Elbow or knee.
  kTwist,  ///< Rotation of the lower bone about its own axis.
  kEndFlexion,
  kEndDeviation,
};
inline constexpr int kLimbAngles = 7;
inline constexpr int kAngleCount =
    static_cast<int>(Angle::kFirstOfLimbs) + 4 * kLimbAngles;

[[nodiscard]] constexpr std::size_t index(Angle angle) {
  return static_cast<std::size_t>(angle);
}
/// The position in an Attitude of an angle of limb `limb` (order of human_limbs()).
[[nodiscard]] constexpr std::size_t limb_angle(std::size_t limb, LimbAngle angle) {
  return index(Angle::kFirstOfLimbs) + limb * kLimbAngles +
         static_cast<std::size_t>(angle);
}

/// A posture in terms of anatomy [rad, m]. All zero is standing upright, arms hanging.
using Attitude = std::array<double, kAngleCount>;

/// A person whose joints are not quite marey's: drawn from anthropometry, with hinges
/// that are askew, a spine that bends unevenly and shoulders that glide.
struct SimulatedBody {
  double stature_m = 0.0;           ///< Floor to top of the head, standing.
  double declared_stature_m = 0.0;  ///< Stature that the session declares.
  double build = 1.0;               ///< Thickness over that of a lean adult.
  Proportions proportions;          ///< In the T-pose, as core/skeleton.h defines them.
  struct Hinge {
    glm::dvec3 axis{0.0};          ///< Unit, in the upper bone's frame.
    glm::dquat carry{1, 0, 0, 0};  ///< Lower bone in the upper bone when straight.
    double rollback_m = 0.0;       ///< The centre moves by this when bent by 90 degrees.
  };
  std::array<Hinge, 4> hinges;  ///< In the order of human_limbs().
  /// Shares of spine, chest and upper chest in the trunk's rotation, per axis.
  std::array<glm::dvec3, 3> spine_shares;
  double neck_share = 0.5;      ///< Share of the neck in the head's rotation.
  double clavicle_raise = 0.2;  ///< Rotation of the collar bone over the arm's elevation.
  double clavicle_forward = 0.1;
  double shoulder_glide_m = 0.0;  ///< Upward, when the arm is raised by 90 degrees.
};

/// Draws a person of 1.45 to 2 m. The lengths of segments spread by 4 to 7 % of their own
/// beyond stature; left and right differ by some millimetres.
[[nodiscard]] SimulatedBody draw_body(Dice& dice);

/// Stands the body on the floor (Y = 0) in a posture: the lower foot's sole touches it,
/// and feet near the floor lie flat.
[[nodiscard]] BoneFrames place(const SimulatedBody& body, const Attitude& attitude);

/// Returns the end of a bone in its own frame: the joint of its main child, or its tip.
[[nodiscard]] glm::dvec3 end_of(HumanBone bone, const Proportions& proportions);

}  // namespace marey::testing
