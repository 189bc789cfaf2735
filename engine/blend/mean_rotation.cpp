// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/mean_rotation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

// Vector of half the rotation angle; |q| = 1.
glm::dvec3 half_log(const glm::dquat& q) {
  const glm::dvec3 v{q.x, q.y, q.z};
  const double sine = glm::length(v);
  const double angle_rad = std::atan2(sine, q.w);
  return sine > 1e-150 ? (angle_rad / sine) * v : v;
}

glm::dquat half_exp(const glm::dvec3& v) {
  const double angle_rad = glm::length(v);
  const double scale = angle_rad > 1e-150 ? std::sin(angle_rad) / angle_rad : 1.0;
  return {std::cos(angle_rad), scale * v.x, scale * v.y, scale * v.z};
}

glm::dquat on_side_of(const glm::dquat& side, const glm::dquat& q) {
  return glm::dot(side, q) < 0.0 ? -q : q;
}

}  // namespace

glm::dquat mean_rotation(std::span<const glm::dquat> rotations,
                         std::span<const double> weights,
                         const glm::dquat* side) {
  MAREY_ASSERT(rotations.size() == weights.size());
  const auto heaviest = static_cast<std::size_t>(
      std::max_element(weights.begin(), weights.end()) - weights.begin());
  MAREY_ASSERT(heaviest < weights.size() && weights[heaviest] > 0.0);
  const glm::dquat reference = side != nullptr ? *side : rotations[heaviest];
  glm::dquat sum{0.0, 0.0, 0.0, 0.0};
  double total = 0.0;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    sum = sum + weights[i] * on_side_of(reference, rotations[i]);
    total += weights[i];
  }
  if (total == weights[heaviest]) return rotations[heaviest];
  // Opposite quaternions cancel: no rotation is between them.
  if (glm::length(sum) < 1e-9 * total) return rotations[heaviest];
  const glm::dquat about = glm::normalize(sum);
  glm::dvec3 mean_log{0.0};
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const glm::dquat q = on_side_of(reference, rotations[i]);
    mean_log += (weights[i] / total) * half_log(glm::conjugate(about) * q);
  }
  return glm::normalize(about * half_exp(mean_log));
}

}  // namespace marey::engine
