// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "retarget/arm_shift.h"
#include "retarget/keep_touches.h"

namespace marey::retarget {

/// One body with one of its arms, shifted or not.
struct ArmOfBody {
  const VolumeInMotion& body;
  ArmPlaces arm;
};

/// Where an arm must go to leave trunk and thighs.
struct ArmNeed {
  glm::dvec3 elbow{0.0};  ///< World, [m].
  glm::dvec3 wrist{0.0};
  double deepest_m = 0.0;  ///< Deeper than the source's arm is in its own body.
};

/// Looks at balls along upper arm, forearm and hand: each is to be as far out of trunk
/// and thighs as the source's is out of its own, and no further than to the surface, on
/// the side on which the source has it. Less than `slack_m` asks for nothing. Pure,
/// allocates nothing; two microseconds.
[[nodiscard]] ArmNeed arm_need(const ArmOfBody& source,
                               const ArmOfBody& avatar,
                               int side,
                               std::size_t t,
                               double slack_m);

/// The longer of two ways.
inline void take_greater(const glm::dvec3& way, glm::dvec3& most) {
  if (glm::dot(way, way) > glm::dot(most, most)) most = way;
}

}  // namespace marey::retarget
