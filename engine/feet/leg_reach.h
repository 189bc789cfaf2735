// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace marey::engine {

/// Share of its length to which a leg is stretched at most, and from which on distances
/// are shortened: a straight knee jumps.
inline constexpr double kMostReach = 0.9985;
inline constexpr double kFreeReach = 0.985;

/// Returns a distance from hip to ankle that a leg can have: the given one up to
/// kFreeReach of its length, then less, at most kMostReach of it. Continuous rate.
[[nodiscard]] double leg_reach_m(double distance_m, double leg_m);

/// Returns how much the hips have to be lowered for a leg to have leg_reach_m() of its
/// distance from hip to ankle [m]. 0 if the ankle is not below, or nothing suffices.
[[nodiscard]] double hips_drop_m(const glm::dvec3& hip_in_world,
                                 const glm::dvec3& ankle_in_world,
                                 double leg_m);

/// Returns the place of an ankle, moved towards the hip to at most `reach_m` from it.
[[nodiscard]] glm::dvec3 ankle_within(const glm::dvec3& hip_in_world,
                                      const glm::dvec3& ankle_in_world,
                                      double reach_m);

}  // namespace marey::engine
