// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/posed_masses.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {

void place_masses_of_pose(const Skeleton& skeleton,
                          std::span<const PointMass> masses,
                          const Pose& pose,
                          std::span<RigidTransform> joints,
                          PosedMasses& out) {
  MAREY_ASSERT(pose.parent_from_joint.size() == skeleton.joints.size());
  world_from_joints(skeleton, pose, joints);
  out.from_com_m.resize(masses.size());
  out.world_from_mass.resize(masses.size());
  glm::dvec3 sum(0.0);
  double mass_kg = 0.0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const RigidTransform& world_from_joint = joints[index(masses[i].joint)];
    out.from_com_m[i] = world_from_joint * masses[i].p_in_joint;
    out.world_from_mass[i] = world_from_joint.rotation;
    sum += masses[i].mass_kg * out.from_com_m[i];
    mass_kg += masses[i].mass_kg;
  }
  out.com_in_world = sum / mass_kg;
  for (glm::dvec3& p : out.from_com_m) p -= out.com_in_world;
}

double total_mass_kg(std::span<const PointMass> masses) {
  double sum_kg = 0.0;
  for (const PointMass& mass : masses) sum_kg += mass.mass_kg;
  return sum_kg;
}

glm::dmat3 own_inertia(const PointMass& mass, const glm::dquat& world_from_mass) {
  const glm::dmat3 turn = glm::mat3_cast(world_from_mass);
  return mass.mass_kg * (turn * mass.inertia_per_kg_m2 * glm::transpose(turn));
}

glm::dmat3 locked_inertia(std::span<const PointMass> masses, const PosedMasses& posed) {
  glm::dmat3 out(0.0);
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const glm::dvec3& p = posed.from_com_m[i];
    out +=
        masses[i].mass_kg * (glm::dot(p, p) * glm::dmat3(1.0) - glm::outerProduct(p, p));
    out += own_inertia(masses[i], posed.world_from_mass[i]);
  }
  return out;
}

glm::dvec3 quick_rotation_vector(const glm::dquat& rotation) {
  const glm::dvec3 v(rotation.x, rotation.y, rotation.z);
  const double s2 = glm::dot(v, v);
  if (s2 > 0.01) return rotation_vector(rotation);
  // Series of 2 asin(s) / s.
  const double ratio =
      2.0 + s2 * (1.0 / 3.0 +
                  s2 * (3.0 / 20.0 +
                        s2 * (5.0 / 56.0 + s2 * (35.0 / 576.0 + s2 * (63.0 / 1408.0)))));
  return (rotation.w < 0.0 ? -ratio : ratio) * v;
}

}  // namespace marey::dynamics
