// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/transform.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace marey {

glm::dvec3 rotation_vector(const glm::dquat& rotation) {
  // q and -q are one rotation: take the one whose angle is at most pi.
  const double sign = rotation.w < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 v = sign * glm::dvec3(rotation.x, rotation.y, rotation.z);
  const double sine = glm::length(v);
  if (sine < 1e-12) return 2.0 * v;
  return v * (2.0 * std::atan2(sine, sign * rotation.w) / sine);
}

glm::dquat rotation_from_vector(const glm::dvec3& vector_rad) {
  const double angle = glm::length(vector_rad);
  if (angle < 1e-12) {
    const glm::dvec3 half = 0.5 * vector_rad;
    return glm::normalize(glm::dquat(1.0, half.x, half.y, half.z));
  }
  const glm::dvec3 v = vector_rad * (std::sin(0.5 * angle) / angle);
  return {std::cos(0.5 * angle), v.x, v.y, v.z};
}

glm::dquat rotation_between(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 a = glm::normalize(from);
  const glm::dvec3 b = glm::normalize(to);
  const double cosine = glm::dot(a, b);
  if (cosine < -1.0 + 1e-14) {
    const glm::dvec3 helper =
        std::abs(a.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 axis = glm::normalize(glm::cross(a, helper));
    return {0.0, axis.x, axis.y, axis.z};
  }
  const glm::dvec3 v = glm::cross(a, b);
  return glm::normalize(glm::dquat(1.0 + cosine, v.x, v.y, v.z));
}

glm::dquat twist_about(const glm::dquat& rotation, const glm::dvec3& axis) {
  const double along = glm::dot(glm::dvec3(rotation.x, rotation.y, rotation.z), axis);
  const glm::dquat twist(rotation.w, along * axis.x, along * axis.y, along * axis.z);
  const double norm = glm::length(twist);
  if (norm < 1e-12) return {1.0, 0.0, 0.0, 0.0};
  return twist / norm;
}

}  // namespace marey
