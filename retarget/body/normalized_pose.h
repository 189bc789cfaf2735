// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "retarget/body/body_map.h"
#include "retarget/body/rotation_curve.h"

namespace marey::retarget {

/// Divisor of the root's position.
enum class RootNormalization {
  kLegLength,  ///< The body stands at its right height.
  kArmLength,  ///< For walking on hands.
  kNone,       ///< Metres stay metres.
};

/// A limb without its size: one segment of variable length (Kulpa 2005, eq. 1.3).
///
/// Limb frame: Z from the limb's root to its end, X towards the elbow or knee (the
/// thesis' P: the half-plane that contains it), Y = Z x X. When the limb is bent, X comes
/// from the joint's position. As it straightens, X changes continuously to the direction
/// in which the upper bone's own hinge axis would bend it.
struct NormalizedLimb {
  double extension = 1.0;  ///< |root to end| over the sum of segment lengths, in [0, 1].
  glm::dquat world_from_limb{1.0, 0.0, 0.0, 0.0};
  /// Elbow or knee from the axis, in the limb's X and Y, over the sum of lengths. Along
  /// +X unless the limb is nearly straight.
  glm::dvec2 mid_offset{0.0};
  /// Rotation of each bone about its own axis, relative to the limb's half-plane.
  double upper_twist_rad = 0.0;
  double lower_twist_rad = 0.0;

  /// Root to end over the sum of segment lengths: CCNorm of eq. 1.3. World axes.
  [[nodiscard]] glm::dvec3 end_from_root() const {
    return extension * (world_from_limb * glm::dvec3(0, 0, 1));
  }
};

/// A posture without a size (Kulpa 2005, 1.1.2): the common part of all humanoids,
/// independent of their number of joints and their rest pose. Every rotation is relative
/// to the canonical T-pose, in world axes: identity everywhere is the T-pose facing +Z.
struct NormalizedPose {
  RootNormalization root_normalization = RootNormalization::kLegLength;
  /// The hips joint in the world, over the length that `root_normalization` names.
  glm::dvec3 root{0.0};
  std::array<std::optional<NormalizedLimb>, 4> limbs{};  ///< As in human_limbs().
  RotationCurve abdomen;  ///< From the hips (knot 0) to the start of the torso.
  RotationCurve torso;    ///< From there to the base of the neck.
  /// Position of the curves along the source's spine, from which its end follows: each
  /// knot except the first of a curve is a rigid bone that starts at the knot before.
  /// nullopt when the source has no vertebrae, or neither neck nor head.
  std::optional<SpineShares> spine;
  RotationCurve
      neck;  ///< From the spine's end (knot 0) to the head; empty without a neck.
  /// World rotation of each bone that is neither a vertebra nor in a complete limb: hips,
  /// clavicles, neck, head, hands, feet, toes. nullopt where the source has none.
  std::array<std::optional<glm::dquat>, kHumanBoneCount> segments{};
};

}  // namespace marey::retarget
