// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/transform.h"
#include "retarget/body/arm_shift.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"

namespace marey::retarget {

/// Penetration that is ignored: the changed length of legs on the floor causes as much.
/// [m]
inline constexpr double kArmSlack_m = 0.002;

/// One posed body with one of its arms, with or without shift. Referenced objects must
/// outlive it.
struct ArmOfBody {
  const BodyVolume& volume;
  std::span<const RigidTransform> world_from_joint;
  ArmPlaces arm;
  /// World Y of the floor; nullopt: hands are not raised.
  std::optional<double> floor_m = std::nullopt;
};

/// Displacement that moves an arm out of trunk and thighs.
struct ArmPenetration {
  glm::dvec3 elbow{0.0};  ///< World, [m].
  glm::dvec3 wrist{0.0};
  double max_depth_m = 0.0;  ///< Depth beyond that of the source's arm in its own body.
  /// Rise of the wrist, and bend of the elbow, that put the hand above the floor. For a
  /// body without known skin: as far above as the source's hand. [m]
  double rise_m = 0.0;
};

/// Computes the penetration of balls along upper arm, forearm and hand. Each ball must be
/// as far out of trunk and thighs as the source's is out of its own, at most at the
/// surface, on the side of the source. Penetrations below `slack_m` count as zero. Pure,
/// allocates nothing; two microseconds.
[[nodiscard]] ArmPenetration arm_penetration(const ArmOfBody& source,
                                             const ArmOfBody& avatar,
                                             int side,
                                             double slack_m);

/// Returns the arm shift that resolves a penetration: the elbow swings about the line
/// from shoulder to wrist, and the wrist moves by the remainder.
[[nodiscard]] ArmShift shift_for(const ArmPenetration& penetration,
                                 const LimbMap& limb,
                                 const ArmPlaces& arm);

/// Replaces `longest` by `way` if `way` is longer.
inline void take_greater(const glm::dvec3& way, glm::dvec3& longest) {
  if (glm::dot(way, way) > glm::dot(longest, longest)) longest = way;
}

}  // namespace marey::retarget
