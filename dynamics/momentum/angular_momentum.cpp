// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/angular_momentum.h"

#include <algorithm>
#include <array>

#include "dynamics/momentum/posed_masses.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

// Angular momentum at `here`, velocities from the difference between two postures.
glm::dvec3 momentum_between(std::span<const PointMass> masses,
                            const PosedMasses& before,
                            const PosedMasses& here,
                            const PosedMasses& after,
                            double span_s) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const glm::dvec3 step = after.from_com_m[i] - before.from_com_m[i];
    sum += masses[i].mass_kg * glm::cross(here.from_com_m[i], step);
    const glm::dvec3 turn = quick_rotation_vector(
        after.world_from_mass[i] * glm::conjugate(before.world_from_mass[i]));
    const glm::dquat& world_from_mass = here.world_from_mass[i];
    sum += world_from_mass *
           (masses[i].mass_kg *
            (masses[i].inertia_per_kg_m2 * (glm::conjugate(world_from_mass) * turn)));
  }
  return sum / span_s;
}

}  // namespace

std::vector<CentroidalState> centroidal_states(const Skeleton& skeleton,
                                               std::span<const PointMass> masses,
                                               FrameRate rate,
                                               std::span<const Pose> poses) {
  const double mass_kg = total_mass_kg(masses);
  MAREY_ASSERT(mass_kg > 0.0 && rate.hz > 0.0);
  std::vector<CentroidalState> out(poses.size());
  std::vector<RigidTransform> joints(skeleton.joints.size());
  std::array<PosedMasses, 3> ring;
  const auto at = [&](std::size_t k) -> PosedMasses& { return ring[k % 3]; };
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (k == 0) place_masses_of_pose(skeleton, masses, poses[0], joints, at(0));
    if (k + 1 < poses.size()) {
      place_masses_of_pose(skeleton, masses, poses[k + 1], joints, at(k + 1));
    }
    out[k].mass_kg = mass_kg;
    out[k].com_in_world = at(k).com_in_world;
    out[k].inertia_kg_m2 = locked_inertia(masses, at(k));
    const std::size_t before = k > 0 ? k - 1 : k;
    const std::size_t after = std::min(k + 1, poses.size() - 1);
    if (after == before) continue;
    const double span_s = static_cast<double>(after - before) / rate.hz;
    out[k].angular_momentum_kg_m2_s =
        momentum_between(masses, at(before), at(k), at(after), span_s);
  }
  return out;
}

}  // namespace marey::dynamics
