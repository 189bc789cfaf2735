// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/find_joint_centres.h"

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace marey::reconstruct {
namespace {

constexpr std::size_t kMinInstants = 10;
constexpr double kCauchyM = 0.010;
// Weight of one expected place in measured instants: enough to determine a free
// direction, too little to bias a measured one noticeably.
constexpr double kExpectationWeight = 0.02;

Eigen::Matrix3d matrix(const glm::dquat& rotation) {
  return Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z)
      .toRotationMatrix();
}

Eigen::Vector3d vector(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

}  // namespace

std::optional<JointCentre> find_joint_centre(std::span<const SegmentPair> instants,
                                             const glm::dvec3& near_in_a,
                                             const glm::dvec3& near_in_b) {
  if (instants.size() < kMinInstants) return std::nullopt;
  std::vector<double> weights(instants.size(), 1.0);
  Vector6 expected;
  expected << vector(near_in_a), vector(near_in_b);
  Vector6 centre = expected;
  double rms_m = 0.0;
  Matrix6 unweighted = Matrix6::Zero();
  for (int round = 0; round < 15; ++round) {
    Matrix6 normal = kExpectationWeight * Matrix6::Identity();
    Vector6 right = kExpectationWeight * expected;
    unweighted.setZero();
    for (std::size_t i = 0; i < instants.size(); ++i) {
      Eigen::Matrix<double, 3, 6> row;
      row << matrix(instants[i].world_from_a.rotation),
          -matrix(instants[i].world_from_b.rotation);
      const Eigen::Vector3d gap = vector(instants[i].world_from_b.translation) -
                                  vector(instants[i].world_from_a.translation);
      normal += weights[i] * row.transpose() * row;
      right += weights[i] * row.transpose() * gap;
      unweighted += row.transpose() * row;
    }
    centre = normal.ldlt().solve(right);
    double sum = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < instants.size(); ++i) {
      const Eigen::Vector3d apart =
          matrix(instants[i].world_from_a.rotation) * centre.head<3>() +
          vector(instants[i].world_from_a.translation) -
          matrix(instants[i].world_from_b.rotation) * centre.tail<3>() -
          vector(instants[i].world_from_b.translation);
      const double d2 = apart.squaredNorm();
      weights[i] = 1.0 / (1.0 + d2 / (kCauchyM * kCauchyM));
      sum += weights[i] * d2;
      total += weights[i];
    }
    rms_m = std::sqrt(sum / total);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6> spectrum(
      unweighted / static_cast<double>(instants.size()));
  return JointCentre{{centre[0], centre[1], centre[2]},
                     {centre[3], centre[4], centre[5]},
                     rms_m,
                     std::sqrt(std::max(0.0, spectrum.eigenvalues()[0]))};
}

}  // namespace marey::reconstruct
