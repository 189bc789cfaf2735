// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/cluster_shape.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "reconstruct/clusters/cluster_frame.h"

namespace marey::reconstruct {
namespace {

constexpr int kShapeRounds = 5;

}  // namespace

std::vector<std::size_t> seen_markers(const MarkerCluster& cluster, std::size_t frame) {
  std::vector<std::size_t> seen;
  for (std::size_t m = 0; m < cluster.markers; ++m) {
    if (cluster.p_in_world[frame * cluster.markers + m]) seen.push_back(m);
  }
  return seen;
}

RigidTransform locate(const MarkerCluster& cluster,
                      const std::vector<glm::dvec3>& shape,
                      std::size_t frame) {
  std::vector<glm::dvec3> world;
  std::vector<glm::dvec3> own;
  for (const std::size_t m : seen_markers(cluster, frame)) {
    world.push_back(*cluster.p_in_world[frame * cluster.markers + m]);
    own.push_back(shape[m]);
  }
  return align(world, own, std::vector<double>(world.size(), 1.0));
}

std::optional<std::vector<glm::dvec3>> find_shape(const MarkerCluster& cluster,
                                                  std::span<const std::size_t> frames) {
  // Starts with the frame that shows most markers; the others are added from frames that
  // show them.
  std::size_t best = frames.front();
  for (const std::size_t f : frames) {
    if (seen_markers(cluster, f).size() > seen_markers(cluster, best).size()) best = f;
  }
  std::vector<glm::dvec3> shape(cluster.markers, glm::dvec3(0.0));
  std::vector<bool> known(cluster.markers, false);
  for (const std::size_t m : seen_markers(cluster, best)) {
    shape[m] = *cluster.p_in_world[best * cluster.markers + m];
    known[m] = true;
  }
  for (int round = 0; round < kShapeRounds; ++round) {
    std::vector<glm::dvec3> sum(cluster.markers, glm::dvec3(0.0));
    std::vector<int> count(cluster.markers, 0);
    for (const std::size_t f : frames) {
      std::vector<glm::dvec3> world;
      std::vector<glm::dvec3> own;
      for (const std::size_t m : seen_markers(cluster, f)) {
        if (!known[m]) continue;
        world.push_back(*cluster.p_in_world[f * cluster.markers + m]);
        own.push_back(shape[m]);
      }
      if (world.size() < kMinClusterMarkers) continue;
      const RigidTransform own_from_world =
          align(world, own, std::vector<double>(world.size(), 1.0));
      for (const std::size_t m : seen_markers(cluster, f)) {
        sum[m] += own_from_world * *cluster.p_in_world[f * cluster.markers + m];
        ++count[m];
      }
    }
    for (std::size_t m = 0; m < cluster.markers; ++m) {
      if (count[m] == 0) continue;
      shape[m] = sum[m] / static_cast<double>(count[m]);
      known[m] = true;
    }
  }
  if (std::find(known.begin(), known.end(), false) != known.end()) return std::nullopt;
  glm::dvec3 middle(0.0);
  for (const glm::dvec3& p : shape) middle += p / static_cast<double>(shape.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (glm::dvec3& p : shape) {
    p -= middle;
    const Eigen::Vector3d v(p.x, p.y, p.z);
    spread += v * v.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  if (axes.eigenvalues()[1] < 1e-3 * axes.eigenvalues()[2]) return std::nullopt;
  return shape;
}

}  // namespace marey::reconstruct
