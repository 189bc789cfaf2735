// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/segments/cluster_geometry.h"

#include <limits>
#include <map>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace marey::reconstruct {

glm::dquat rotation_onto(glm::dvec3 a1, glm::dvec3 a2, glm::dvec3 b1, glm::dvec3 b2) {
  const auto basis = [](const glm::dvec3& first, const glm::dvec3& second) {
    const glm::dvec3 x = glm::normalize(first);
    const glm::dvec3 y = glm::normalize(second - glm::dot(second, x) * x);
    return glm::dmat3(x, y, glm::cross(x, y));
  };
  return glm::normalize(glm::quat_cast(basis(b1, b2) * glm::transpose(basis(a1, a2))));
}

glm::dvec3 place_inside(const TagCluster& cluster) {
  constexpr double kDepth_m = 0.07;
  constexpr double kDepthWeight = 0.05;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& [tag, cluster_from_tag] : cluster.cluster_from_tag) {
    const glm::dvec3 z = cluster_from_tag.rotation * glm::dvec3(0, 0, 1);
    const glm::dvec3& c = cluster_from_tag.translation;
    const Eigen::Vector3d into(z.x, z.y, z.z);
    const Eigen::Vector3d middle(c.x, c.y, c.z);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - into * into.transpose();
    normal += across + kDepthWeight * Eigen::Matrix3d::Identity();
    right += across * middle + kDepthWeight * (middle + kDepth_m * into);
  }
  const Eigen::Vector3d place = normal.ldlt().solve(right);
  return {place.x(), place.y(), place.z()};
}

ClusterPoses medoid_poses(std::span<const ClusterPoses> frames) {
  std::map<HumanBone, std::vector<RigidTransform>> by_bone;
  for (const ClusterPoses& frame : frames) {
    for (const auto& [bone, pose] : frame) by_bone[bone].push_back(pose);
  }
  ClusterPoses out;
  for (const auto& [bone, poses] : by_bone) {
    double minimum = std::numeric_limits<double>::infinity();
    for (const RigidTransform& candidate : poses) {
      double sum = 0.0;
      for (const RigidTransform& other : poses) {
        sum += glm::length(candidate.translation - other.translation) +
               glm::length(
                   rotation_vector(glm::conjugate(candidate.rotation) * other.rotation));
      }
      if (sum < minimum) {
        minimum = sum;
        out[bone] = candidate;
      }
    }
  }
  return out;
}

}  // namespace marey::reconstruct
