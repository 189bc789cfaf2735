// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace marey::testing {

/// Returns the rotation that maps the axes `a` and `b` to `to_a` and `to_b`.
/// Precondition: all have length 1, and both pairs are perpendicular.
[[nodiscard]] inline glm::dquat rotation_of_axes(const glm::dvec3& a,
                                                 const glm::dvec3& b,
                                                 const glm::dvec3& to_a,
                                                 const glm::dvec3& to_b) {
  const glm::dmat3 from(a, b, glm::cross(a, b));
  const glm::dmat3 to(to_a, to_b, glm::cross(to_a, to_b));
  return glm::quat_cast(to * glm::transpose(from));
}

}  // namespace marey::testing
