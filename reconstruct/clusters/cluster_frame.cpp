// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/cluster_frame.h"

#include <Eigen/Eigenvalues>

#include "core/base/assert.h"

namespace marey::reconstruct {
namespace {

constexpr int kRounds = 3;

glm::dvec3 weighted_mean(std::span<const glm::dvec3> points,
                         std::span<const double> weights) {
  glm::dvec3 sum(0.0);
  double weight = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += weights[i] * points[i];
    weight += weights[i];
  }
  return sum / weight;
}

/// Returns the unit quaternion whose rotation of `a` about its mean is nearest to `b`.
glm::dquat turn(const Eigen::Matrix3d& m) {
  Eigen::Matrix4d n;
  n << m(0, 0) + m(1, 1) + m(2, 2), m(1, 2) - m(2, 1), m(2, 0) - m(0, 2),
      m(0, 1) - m(1, 0), m(1, 2) - m(2, 1), m(0, 0) - m(1, 1) - m(2, 2),
      m(0, 1) + m(1, 0), m(2, 0) + m(0, 2), m(2, 0) - m(0, 2), m(0, 1) + m(1, 0),
      m(1, 1) - m(0, 0) - m(2, 2), m(1, 2) + m(2, 1), m(0, 1) - m(1, 0),
      m(2, 0) + m(0, 2), m(1, 2) + m(2, 1), m(2, 2) - m(0, 0) - m(1, 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  return {q[0], q[1], q[2], q[3]};
}

}  // namespace

RigidTransform align(std::span<const glm::dvec3> p_in_a,
                     std::span<const glm::dvec3> p_in_b,
                     std::span<const double> weights) {
  MAREY_ASSERT(!weights.empty());
  MAREY_ASSERT(p_in_a.size() == weights.size() && p_in_b.size() == weights.size());
  const glm::dvec3 mean_a = weighted_mean(p_in_a, weights);
  const glm::dvec3 mean_b = weighted_mean(p_in_b, weights);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const glm::dvec3 a = weights[i] * (p_in_a[i] - mean_a);
    const glm::dvec3 b = p_in_b[i] - mean_b;
    spread += Eigen::Vector3d(a.x, a.y, a.z) * Eigen::Vector3d(b.x, b.y, b.z).transpose();
  }
  const glm::dquat b_from_a = turn(spread);
  return {b_from_a, mean_b - b_from_a * mean_a};
}

std::vector<glm::dvec3> mean_shape(std::span<const glm::dvec3> frames,
                                   std::span<const double> weights) {
  const std::size_t points = weights.size();
  MAREY_ASSERT(points > 0 && !frames.empty() && frames.size() % points == 0);
  const std::size_t count = frames.size() / points;
  std::vector<glm::dvec3> shape(frames.begin(),
                                frames.begin() + static_cast<std::ptrdiff_t>(points));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<glm::dvec3> sum(points, glm::dvec3(0.0));
    for (std::size_t f = 0; f < count; ++f) {
      const auto seen = frames.subspan(f * points, points);
      const RigidTransform shape_from_world = align(seen, shape, weights);
      for (std::size_t i = 0; i < points; ++i) sum[i] += shape_from_world * seen[i];
    }
    for (std::size_t i = 0; i < points; ++i) {
      shape[i] = sum[i] / static_cast<double>(count);
    }
  }
  return shape;
}

}  // namespace marey::reconstruct
