// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/character.h"
#include "core/transform.h"

namespace marey {

/// Returns the centre of mass of a posture, in the world. [m] Linear in masses.
/// Precondition: the sum of the masses is positive; their joints are of the posture.
[[nodiscard]] inline glm::dvec3 centre_of_mass(
    std::span<const PointMass> masses, std::span<const RigidTransform> world_from_joint) {
  glm::dvec3 sum(0.0);
  double mass_kg = 0.0;
  for (const PointMass& mass : masses) {
    sum += mass.mass_kg * (world_from_joint[index(mass.joint)] * mass.p_in_joint);
    mass_kg += mass.mass_kg;
  }
  return sum / mass_kg;
}

}  // namespace marey
