// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/transform.h"
#include "retarget/arm_shift.h"
#include "retarget/body_map.h"
#include "retarget/body_volume.h"

namespace marey::retarget {

/// So deep in a body is nobody's business: what legs that were put on the floor take and
/// give. [m]
inline constexpr double kArmSlack_m = 0.002;

/// One posed body with one of its arms, shifted or not. What it refers to outlives it.
struct ArmOfBody {
  const BodyVolume& volume;
  std::span<const RigidTransform> world_from_joint;
  ArmPlaces arm;
  /// World Y of the floor it stands on; nullopt: nothing keeps hands up.
  std::optional<double> floor_m = std::nullopt;
};

/// Where an arm must go to leave trunk and thighs.
struct ArmNeed {
  glm::dvec3 elbow{0.0};  ///< World, [m].
  glm::dvec3 wrist{0.0};
  double deepest_m = 0.0;  ///< Deeper than the source's arm is in its own body.
  /// How much the wrist must rise, and the elbow bend, for the hand to be over the floor;
  /// of a body whose skin is not known, as far as the source's is over its own. [m]
  double rise_m = 0.0;
};

/// Looks at balls along upper arm, forearm and hand: each is to be as far out of trunk
/// and thighs as the source's is out of its own, and no further than to the surface, on
/// the side on which the source has it. Less than `slack_m` asks for nothing. Pure,
/// allocates nothing; two microseconds.
[[nodiscard]] ArmNeed arm_need(const ArmOfBody& source,
                               const ArmOfBody& avatar,
                               int side,
                               double slack_m);

/// The same as a shift of an arm at these places: what the elbow gains by swinging about
/// the line from shoulder to wrist, and by going with the wrist.
[[nodiscard]] ArmShift shift_for(const ArmNeed& lacks,
                                 const LimbMap& limb,
                                 const ArmPlaces& arm);

/// The longer of two ways.
inline void take_greater(const glm::dvec3& way, glm::dvec3& most) {
  if (glm::dot(way, way) > glm::dot(most, most)) most = way;
}

}  // namespace marey::retarget
