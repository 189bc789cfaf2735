// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/zero_moment_point.h"

#include "dynamics/balance/local_cubic.h"

#include "core/base/assert.h"

namespace marey::dynamics {

std::vector<GroundReaction> ground_reactions(
    std::span<const glm::dvec3> com_in_world,
    std::span<const glm::dvec3> momentum_per_kg_m2_s,
    FrameRate rate,
    const ZmpOptions& options) {
  MAREY_ASSERT(momentum_per_kg_m2_s.empty() ||
               momentum_per_kg_m2_s.size() == com_in_world.size());
  const LocalCubic derive(com_in_world.size(), rate, options.smoothing_s);
  std::vector<GroundReaction> out(com_in_world.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    const std::size_t first = derive.first(t);
    const glm::dvec3 acceleration =
        weighted_sum(derive.curvature(t), com_in_world, first);
    const glm::dvec3 moment =
        momentum_per_kg_m2_s.empty()
            ? glm::dvec3(0.0)
            : weighted_sum(derive.slope(t), momentum_per_kg_m2_s, first);
    const glm::dvec3 force = acceleration + glm::dvec3(0.0, options.gravity_m_s2, 0.0);
    out[t].force_m_s2 = force;
    if (force.y < kLoadedShare * options.gravity_m_s2) continue;
    const glm::dvec3& c = com_in_world[t];
    const double height_m = c.y - options.floor_height_m;
    out[t].zmp_xz_m = glm::dvec2(c.x - (force.x * height_m - moment.z) / force.y,
                                 c.z - (force.z * height_m + moment.x) / force.y);
  }
  return out;
}

}  // namespace marey::dynamics
