// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/rotation_curve.h"

namespace marey::retarget {

/// What the root's position is divided by.
enum class RootNormalization {
  kLegLength,  ///< The body stands at its right height.
  kArmLength,  ///< For walking on hands.
  kNone,       ///< Metres stay metres.
};

/// A limb without its size: one segment of variable length (Kulpa 2005, eq. 1.3).
///
/// Limb frame: Z from the limb's root to its end, X towards the elbow or knee (the
/// thesis' P: the half-plane that holds it), Y = Z x X. When the limb is bent, X comes
/// from the joint's position; as it straightens, X passes continuously over to where the
/// upper bone's own hinge axis would bend it.
struct NormalizedLimb {
  double extension = 1.0;  ///< |root to end| over the sum of segment lengths, in [0, 1].
  glm::dquat world_from_limb{1.0, 0.0, 0.0, 0.0};
  /// Elbow or knee from the axis, in the limb's X and Y, over the sum of lengths. Along
  /// +X unless the limb is nearly straight.
  glm::dvec2 mid_offset{0.0};
  /// Turn of each bone about its own axis, away from lying in the half-plane.
  double upper_twist_rad = 0.0;
  double lower_twist_rad = 0.0;

  /// Root to end over the sum of segment lengths: CCNorm of eq. 1.3. World axes.
  [[nodiscard]] glm::dvec3 end_from_root() const {
    return extension * (world_from_limb * glm::dvec3(0, 0, 1));
  }
};

/// A posture without a size (Kulpa 2005, 1.1.2): what all humanoids have in common,
/// however many joints they have and however they rest. Every rotation is relative to the
/// canonical T-pose, in world axes: identity everywhere is the T-pose facing +Z.
struct NormalizedPose {
  RootNormalization root_normalization = RootNormalization::kLegLength;
  /// The hips joint in the world, over the length that `root_normalization` names.
  glm::dvec3 root{0.0};
  std::array<std::optional<NormalizedLimb>, 4> limbs{};  ///< As in human_limbs().
  RotationCurve abdomen;  ///< From the hips (knot 0) to where the torso begins.
  RotationCurve torso;    ///< From there to the base of the neck.
  /// Where the curves lie along the source's spine, whose end follows from them: each
  /// knot but the first of a curve is a rigid bone, which reaches from the knot before.
  /// nullopt when the source has no vertebrae, or neither neck nor head.
  std::optional<SpineShares> spine;
  RotationCurve
      neck;  ///< From the spine's end (knot 0) to the head; empty without a neck.
  /// World rotation of each bone that is neither a vertebra nor in a complete limb: hips,
  /// clavicles, neck, head, hands, feet, toes. nullopt where the source has none.
  std::array<std::optional<glm::dquat>, kHumanBoneCount> segments{};
};

/// Removes the body from a posture (eq. 1.3). Lossless: expand() on the same body gives
/// every marked bone and vertebra back. One to two microseconds; allocates nothing.
/// Precondition: `world_from_joint` are the joints' frames in the world, as
/// world_from_joints() gives them, for the skeleton that `map` was made from.
void normalize(const BodyMap& map,
               std::span<const RigidTransform> world_from_joint,
               NormalizedPose& out,
               RootNormalization root = RootNormalization::kLegLength);

/// The same in one call; allocates its forward kinematics.
[[nodiscard]] NormalizedPose normalize(
    const Skeleton& skeleton,
    const BodyMap& map,
    const Pose& pose,
    RootNormalization root = RootNormalization::kLegLength);

/// Gives a posture a body (eq. 1.4): limb ends at root + v * sum of lengths, elbows and
/// knees by the law of cosines, vertebrae sampled from the spine curves and turned so
/// that neck and shoulders lie where these put them (place_spine()). A limb that cannot
/// fold or stretch as asked goes as far as it can. Joints without a mark, and bones that
/// the source does not have, stay as at rest in their parent. `world_from_joint` gets
/// every joint's frame in the world, `out` the pose. A few microseconds; allocates
/// nothing when `out` has one entry per joint already. Precondition: `map` was made from
/// `body`; one `world_from_joint` per joint.
void expand(const NormalizedPose& pose,
            const Skeleton& body,
            const BodyMap& map,
            std::span<RigidTransform> world_from_joint,
            Pose& out);

/// The same in one call; allocates its answer.
[[nodiscard]] Pose expand(const NormalizedPose& pose,
                          const Skeleton& body,
                          const BodyMap& map);

/// The length that a body's root position is divided by [m]; 1 for kNone.
/// Precondition: a body without arms is not asked for its arm length.
[[nodiscard]] double root_unit_m(const BodyMap& map, RootNormalization root);

}  // namespace marey::retarget
