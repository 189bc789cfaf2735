// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::testing {

/// Differences by which a velocity is computed.
enum class Differences {
  kThreePoint,  ///< Central: (f(+1) - f(-1)) / 2 h.
  kFivePoint,   ///< (8 f(+1) - 8 f(-1) - f(+2) + f(-2)) / 12 h.
};

/// Returns the angular momentum about the centre of mass in world axes [kg m^2/s], of
/// every frame whose differences stay within `poses`: without the first and the last one
/// (kThreePoint) or two (kFivePoint). Does not use the code of the rooms: matrices for
/// the joints, angular velocities from logarithms of quaternions.
[[nodiscard]] std::vector<glm::dvec3> judged_momentum(const Skeleton& skeleton,
                                                      std::span<const PointMass> masses,
                                                      double rate_hz,
                                                      std::span<const Pose> poses,
                                                      Differences differences);

/// Returns the standard deviation of the component that varies most.
[[nodiscard]] double largest_sd(std::span<const glm::dvec3> values);

/// Returns the centre of mass of a pose, in the world. [m]
[[nodiscard]] glm::dvec3 judged_com(const Skeleton& skeleton,
                                    std::span<const PointMass> masses,
                                    const Pose& pose);

/// Returns the inertia of a pose about its centre of mass in world axes [kg m^2], by the
/// parallel axis theorem.
[[nodiscard]] glm::dmat3 judged_inertia(const Skeleton& skeleton,
                                        std::span<const PointMass> masses,
                                        const Pose& pose);

}  // namespace marey::testing
