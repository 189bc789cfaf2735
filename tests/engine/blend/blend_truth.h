// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/engine/blend_posture.h"

namespace marey::engine {

/// Returns the rotation vector of a rotation by at most half a turn. [rad]
inline glm::dvec3 log_of(glm::dquat q) {
  if (q.w < 0.0) q = -q;
  const glm::dvec3 v{q.x, q.y, q.z};
  const double sine = glm::length(v);
  return sine > 1e-14 ? (2.0 * std::atan2(sine, q.w) / sine) * v : 2.0 * v;
}

inline glm::dquat exp_of(const glm::dvec3& vector_rad) {
  const double angle_rad = glm::length(vector_rad);
  return angle_rad > 1e-14 ? glm::angleAxis(angle_rad, vector_rad / angle_rad)
                           : glm::dquat{1.0, 0.5 * vector_rad};
}

inline double angle_between_rad(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(log_of(glm::conjugate(a) * b));
}

inline glm::dvec3 random_axis(std::mt19937& random) {
  std::normal_distribution<double> normal;
  glm::dvec3 axis{0.0};
  while (glm::length(axis) < 0.1) axis = {normal(random), normal(random), normal(random)};
  return glm::normalize(axis);
}

inline glm::dquat random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  glm::dquat q{0.0, 0.0, 0.0, 0.0};
  while (glm::length(q) < 0.1) {
    q = {normal(random), normal(random), normal(random), normal(random)};
  }
  return glm::normalize(q);
}

inline double random_in(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Returns rotations that are pairwise at most `spread_rad` apart.
inline std::vector<glm::dquat> random_spread(std::mt19937& random,
                                             std::size_t count,
                                             double spread_rad) {
  const glm::dquat centre = random_rotation(random);
  std::vector<glm::dquat> out;
  while (out.size() < count) {
    const glm::dquat q =
        centre * exp_of(random_in(random, 0.0, spread_rad) * random_axis(random));
    bool is_near = true;
    for (const glm::dquat& other : out) {
      is_near = is_near && angle_between_rad(other, q) <= spread_rad;
    }
    if (is_near) out.push_back(random_in(random, -1.0, 1.0) < 0.0 ? -q : q);
  }
  return out;
}

/// Returns the intrinsic mean: the fixed point of tangent steps.
inline glm::dquat karcher_mean(std::span<const glm::dquat> rotations,
                               std::span<const double> weights) {
  double total = 0.0;
  for (const double weight : weights) total += weight;
  glm::dquat mean = rotations[0];
  for (int step = 0; step < 200; ++step) {
    glm::dvec3 log{0.0};
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      log += weights[i] / total * log_of(glm::conjugate(mean) * rotations[i]);
    }
    mean = glm::normalize(mean * exp_of(log));
    if (glm::length(log) < 1e-14) break;
  }
  return mean;
}

inline glm::dquat rotation_in(const BlendPosture& posture, std::size_t i) {
  return glm::normalize(glm::dquat{static_cast<double>(posture.w[i]),
                                   static_cast<double>(posture.x[i]),
                                   static_cast<double>(posture.y[i]),
                                   static_cast<double>(posture.z[i])});
}

inline void set_rotation_in(BlendPosture& posture, std::size_t i, const glm::dquat& q) {
  posture.x[i] = static_cast<float>(q.x);
  posture.y[i] = static_cast<float>(q.y);
  posture.z[i] = static_cast<float>(q.z);
  posture.w[i] = static_cast<float>(q.w);
}

inline void randomise_values(std::mt19937& random, BlendPosture& posture) {
  const auto value = [&](double low, double high) {
    return static_cast<float>(random_in(random, low, high));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    posture.fold_rad[i] = value(0.5, 1.0);
    posture.mid_x[i] = value(0.0, 0.3);
    posture.mid_y[i] = value(-0.02, 0.02);
    posture.upper_twist_rad[i] = value(-1.4, 1.4);
    posture.lower_twist_rad[i] = value(-1.4, 1.4);
  }
  posture.height_legs = value(0.6, 1.1);
  posture.abdomen_share = value(0.1, 0.3);
  posture.torso_share = value(0.4, 0.6);
}

/// Returns postures whose rotations are pairwise at most `spread_rad` apart.
inline std::vector<BlendPosture> random_postures(std::mt19937& random,
                                                 std::size_t count,
                                                 double spread_rad) {
  std::vector<BlendPosture> out(count);
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    std::vector<glm::dquat> rotations(count, glm::dquat(1.0, 0.0, 0.0, 0.0));
    if (i < kUsedRotations) rotations = random_spread(random, count, spread_rad);
    for (std::size_t p = 0; p < count; ++p) set_rotation_in(out[p], i, rotations[p]);
  }
  for (BlendPosture& posture : out) randomise_values(random, posture);
  return out;
}

}  // namespace marey::engine
