// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/floor.h"

namespace marey::retarget {

/// Height and normal of the floor at one place and time.
struct FloorSpot {
  FloorPartIndex part;
  double height_m = 0.0;
  glm::dvec3 normal_in_world{0.0, 1.0, 0.0};  ///< Unit; exactly Y where it is level.
};

/// Returns the displacement of a part at `time_s`. It passes through the part's keys with
/// continuous speed and acceleration, at rest before the first and after the last,
/// without overshoot: where a coordinate turns back or waits, it comes to rest; keys in a
/// line at steady speed are passed at that speed. (Quintics whose speed at a key is the
/// harmonic mean of those on either side, after Fritsch and Butland 1984, and whose
/// acceleration is 0 there.)
[[nodiscard]] glm::dvec3 moved_at(const FloorPart& part, double time_s);

/// Returns the plane of a part at (x, z), also beyond its edges, or the base for nullopt.
[[nodiscard]] FloorSpot plane_at(const Floor& floor,
                                 FloorPartIndex part,
                                 const glm::dvec2& xz_in_world,
                                 double time_s);

/// Returns the floor at (x, z): the highest part there, edges included (the first of
/// equal ones), else the base. It is discontinuous at edges. Linear in parts and their
/// keys.
[[nodiscard]] FloorSpot floor_at(const Floor& floor,
                                 const glm::dvec2& xz_in_world,
                                 double time_s);

}  // namespace marey::retarget
