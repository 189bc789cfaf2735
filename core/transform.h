// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey {

/// Rigid motion between two frames. Name every instance `b_from_a`:
///   p_in_b = b_from_a * p_in_a          c_from_a = c_from_b * b_from_a
struct RigidTransform {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< Unit. GLM order: constructor w,x,y,z.
  glm::dvec3 translation{0.0};              ///< [m], in the target frame.
};

[[nodiscard]] inline glm::dvec3 operator*(const RigidTransform& b_from_a,
                                          const glm::dvec3& p_in_a) {
  return b_from_a.rotation * p_in_a + b_from_a.translation;
}
[[nodiscard]] inline RigidTransform operator*(const RigidTransform& c_from_b,
                                              const RigidTransform& b_from_a) {
  return {c_from_b.rotation * b_from_a.rotation, c_from_b * b_from_a.translation};
}
[[nodiscard]] inline RigidTransform inverse(const RigidTransform& b_from_a) {
  const glm::dquat a_from_b = glm::conjugate(b_from_a.rotation);
  return {a_from_b, -(a_from_b * b_from_a.translation)};
}

/// Returns the rotation vector (axis times angle, [rad], angle in [0, pi]) of a unit
/// quaternion.
[[nodiscard]] glm::dvec3 rotation_vector(const glm::dquat& rotation);

/// Returns the unit quaternion of a rotation vector [rad]. Inverse of rotation_vector().
[[nodiscard]] glm::dquat rotation_from_vector(const glm::dvec3& vector_rad);

/// Returns the smallest rotation that takes direction `from` onto direction `to`; both
/// non-zero, any length. Opposite directions turn about any axis perpendicular to `from`.
[[nodiscard]] glm::dquat rotation_between(const glm::dvec3& from, const glm::dvec3& to);

/// Returns the part of `rotation` that turns about the unit `axis`: rotation = swing *
/// twist, and the swing's axis is perpendicular to `axis`. Identity when the swing is a
/// half turn and the twist therefore undefined.
[[nodiscard]] glm::dquat twist_about(const glm::dquat& rotation, const glm::dvec3& axis);

}  // namespace marey
