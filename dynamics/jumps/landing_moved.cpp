// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/landing_moved.h"

#include <glm/geometric.hpp>

namespace marey::dynamics {
namespace {

/// Direction of a jump that does not travel is ahead of the feet; here +Z. [m]
constexpr double kInPlace_m = 0.02;
constexpr double kInPlace_m_s = 0.02;

}  // namespace

glm::dvec3 landing_moved(const Jump& jump, const JumpWish& wish) {
  glm::dvec3 moved(0.0);
  if (!jump.landing_feet_in_world) return moved;
  const glm::dvec3 landing = *jump.landing_feet_in_world;
  if (wish.landing_in_world) return *wish.landing_in_world - landing;
  if (wish.box_m) {
    moved.y = *wish.box_m - (landing.y - jump.takeoff_feet_in_world.y);
  }
  if (wish.length_m) {
    glm::dvec3 way = landing - jump.takeoff_feet_in_world;
    way.y = 0.0;
    const double length_m = glm::length(way);
    glm::dvec3 ahead(0.0, 0.0, 1.0);
    const glm::dvec3 speed(jump.takeoff.velocity_m_s.x, 0.0, jump.takeoff.velocity_m_s.z);
    if (length_m > kInPlace_m) {
      ahead = way / length_m;
    } else if (glm::length(speed) > kInPlace_m_s) {
      ahead = glm::normalize(speed);
    }
    const glm::dvec3 target = jump.takeoff_feet_in_world + *wish.length_m * ahead;
    moved.x = target.x - landing.x;
    moved.z = target.z - landing.z;
  }
  return moved;
}

}  // namespace marey::dynamics
