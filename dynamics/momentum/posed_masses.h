// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"

namespace marey::dynamics {

/// Masses of a body in one posture. World axes.
struct PosedMasses {
  glm::dvec3 com_in_world{0.0};
  std::vector<glm::dvec3> from_com_m;       ///< Centre of each mass.
  std::vector<glm::dquat> world_from_mass;  ///< Rotation of each mass.
};

/// Computes `out`. `joints` is scratch, one per joint. Allocates nothing if `out` has one
/// entry per mass. Preconditions: as centroidal_states().
void place_masses_of_pose(const Skeleton& skeleton,
                          std::span<const PointMass> masses,
                          const Pose& pose,
                          std::span<RigidTransform> joints,
                          PosedMasses& out);

/// Returns the sum of the masses. [kg]
[[nodiscard]] double total_mass_kg(std::span<const PointMass> masses);

/// Returns the inertia of a mass about its own centre. World axes, [kg m^2].
[[nodiscard]] glm::dmat3 own_inertia(const PointMass& mass,
                                     const glm::dquat& world_from_mass);

/// Returns the inertia of all masses about their common centre. World axes, [kg m^2].
[[nodiscard]] glm::dmat3 locked_inertia(std::span<const PointMass> masses,
                                        const PosedMasses& posed);

/// Returns the rotation vector of a rotation, in [rad], length 0 to pi. As
/// rotation_vector() to 1e-13, without trigonometry below 0.2 rad.
[[nodiscard]] glm::dvec3 quick_rotation_vector(const glm::dquat& rotation);

/// Returns the cross product a x b for the matrix a b^T, and so the sum of cross products
/// for a sum of such matrices.
[[nodiscard]] inline glm::dvec3 axial(const glm::dmat3& a_bt) {
  // GLM stores columns: a_bt[column][row].
  return {a_bt[2][1] - a_bt[1][2], a_bt[0][2] - a_bt[2][0], a_bt[1][0] - a_bt[0][1]};
}

}  // namespace marey::dynamics
