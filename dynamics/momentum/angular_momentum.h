// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::dynamics {

/// Mass, momentum and inertia of a posture about its centre of mass (Orin, Goswami & Lee
/// 2013). World axes.
struct CentroidalState {
  double mass_kg = 0.0;
  glm::dvec3 com_in_world{0.0};
  glm::dmat3 inertia_kg_m2{0.0};  ///< Locked: all joints fixed.
  glm::dvec3 angular_momentum_kg_m2_s{0.0};
};

/// Computes the state of every frame. Velocities are central differences (one-sided at
/// the ends), angular velocities from the rotation between the two neighbours. Linear in
/// frames and masses. Preconditions: the masses are on the skeleton's joints and their
/// sum is above 0; the rate is above 0; poses are of the skeleton.
[[nodiscard]] std::vector<CentroidalState> centroidal_states(
    const Skeleton& skeleton,
    std::span<const PointMass> masses,
    FrameRate rate,
    std::span<const Pose> poses);

}  // namespace marey::dynamics
