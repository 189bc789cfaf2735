// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/leg_reach.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace marey::engine {

double leg_reach_m(double distance_m, double leg_m) {
  const double free_m = kFreeReach * leg_m;
  if (distance_m <= free_m) return distance_m;
  const double width_m = (kMostReach - kFreeReach) * leg_m;
  return free_m + width_m * std::tanh((distance_m - free_m) / width_m);
}

double hips_drop_m(const glm::dvec3& hip_in_world,
                   const glm::dvec3& ankle_in_world,
                   double leg_m) {
  const glm::dvec3 down = hip_in_world - ankle_in_world;
  const double reach_m = leg_reach_m(glm::length(down), leg_m);
  const double square = reach_m * reach_m - down.x * down.x - down.z * down.z;
  if (down.y <= 0.0 || square <= 0.0) return 0.0;
  return std::max(0.0, down.y - std::sqrt(square));
}

glm::dvec3 ankle_within(const glm::dvec3& hip_in_world,
                        const glm::dvec3& ankle_in_world,
                        double reach_m) {
  const glm::dvec3 away = ankle_in_world - hip_in_world;
  const double distance_m = glm::length(away);
  if (distance_m <= reach_m) return ankle_in_world;
  return hip_in_world + (reach_m / distance_m) * away;
}

}  // namespace marey::engine
