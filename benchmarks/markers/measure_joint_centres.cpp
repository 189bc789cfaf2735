// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Joint centres of simulated joints: plain SCoRE (Ehrig et al. 2006) on rigid fits of the
// true shapes, and joint_between_clusters(), from the same samples.
//
//   measure_joint_centres [RUNS]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/transform.h"
#include "reconstruct/clusters/cluster_frame.h"
#include "reconstruct/clusters/joint_between_clusters.h"
#include "tests/support/simulation/joint_simulation.h"

namespace marey {
namespace {

constexpr std::size_t kMinMarkers = 3;

using reconstruct::MarkerCluster;
using testing::JointSimulation;

std::optional<RigidTransform> world_from_cluster(const MarkerCluster& cluster,
                                                 const std::vector<glm::dvec3>& shape,
                                                 std::size_t frame) {
  std::vector<glm::dvec3> own;
  std::vector<glm::dvec3> world;
  for (std::size_t m = 0; m < cluster.markers; ++m) {
    const auto& p = cluster.p_in_world[frame * cluster.markers + m];
    if (!p) continue;
    own.push_back(shape[m]);
    world.push_back(*p);
  }
  if (own.size() < kMinMarkers) return std::nullopt;
  return reconstruct::align(own, world, std::vector<double>(own.size(), 1.0));
}

/// Least squares of R_a c_a + t_a = R_b c_b + t_b, eq. 5 of the paper. c_a.
glm::dvec3 score(const JointSimulation& s,
                 const MarkerCluster& in_a,
                 const MarkerCluster& in_b) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  const std::size_t frames = s.a_in_world.size() / JointSimulation::kMarkers;
  for (std::size_t f = 0; f < frames; ++f) {
    const auto a = world_from_cluster(in_a, s.shape_in_a, f);
    const auto b = world_from_cluster(in_b, s.shape_in_b, f);
    if (!a || !b) continue;
    Eigen::Matrix<double, 3, 6> row;
    const glm::dmat3 turn_a = glm::mat3_cast(a->rotation);
    const glm::dmat3 turn_b = glm::mat3_cast(b->rotation);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        row(i, j) = turn_a[j][i];
        row(i, j + 3) = -turn_b[j][i];
      }
    }
    const glm::dvec3 gap = b->translation - a->translation;
    normal += row.transpose() * row;
    right += row.transpose() * Eigen::Vector3d(gap.x, gap.y, gap.z);
  }
  const Eigen::Matrix<double, 6, 1> found = normal.ldlt().solve(right);
  return {found[0], found[1], found[2]};
}

void measure(bool hard, bool around_rim, double cone_deg, int runs) {
  double score_m2 = 0.0;
  double ours_m2 = 0.0;
  double in_sigmas2 = 0.0;
  int declined = 0;
  for (int run = 0; run < runs; ++run) {
    testing::JointSimulationOptions options;
    options.cone_rad = cone_deg * std::numbers::pi / 180.0;
    options.around_rim = around_rim;
    options.soft_tissue_m = hard ? 0.010 : 0.0;
    options.dropouts = hard ? 0.2 : 0.0;
    options.seed = static_cast<std::uint64_t>(run) + 1;
    const auto s = testing::simulate_joint(options);
    const MarkerCluster in_a{JointSimulation::kMarkers, s.a_in_world};
    const MarkerCluster in_b{JointSimulation::kMarkers, s.b_in_world};
    const glm::dvec3 off = score(s, in_a, in_b) - s.joint_in_a;
    score_m2 += glm::dot(off, off);
    const auto found = reconstruct::joint_between_clusters(in_a, in_b);
    if (!found) {
      ++declined;
      continue;
    }
    const std::vector<double> even(JointSimulation::kMarkers, 1.0);
    const RigidTransform true_from_found =
        reconstruct::align(found->shape_a, s.shape_in_a, even);
    const glm::dvec3 error = true_from_found * found->p_in_a - s.joint_in_a;
    ours_m2 += glm::dot(error, error);
    in_sigmas2 += glm::dot(error, error) / (3.0 * found->sigma_a_m * found->sigma_a_m);
  }
  const double counted = runs - declined;
  std::printf(
      "%-6s %-8s cone %2.0f: SCoRE %6.2f mm, marey %5.2f mm RMS (in its own sigmas "
      "%.2f), %d of %d declined\n",
      hard ? "hard" : "clean",
      around_rim ? "its rim" : "all over",
      cone_deg,
      1e3 * std::sqrt(score_m2 / runs),
      1e3 * std::sqrt(ours_m2 / counted),
      std::sqrt(in_sigmas2 / counted),
      declined,
      runs);
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 40;
  if (runs < 1) {
    std::fprintf(stderr, "usage: measure_joint_centres [RUNS]\n");
    return 2;
  }
  for (const bool hard : {false, true}) {
    for (const bool around_rim : {true, false}) {
      for (const double cone_deg : {20.0, 45.0, 90.0}) {
        marey::measure(hard, around_rim, cone_deg, runs);
      }
    }
  }
  return 0;
}
