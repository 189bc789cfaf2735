// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/joint_between_clusters.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "reconstruct/clusters/cluster_frame.h"
#include "tests/support/simulation/joint_simulation.h"

namespace marey::reconstruct {
namespace {

using testing::JointSimulation;
using testing::simulate_joint;

std::optional<ClusterJoint> find(const JointSimulation& s) {
  return joint_between_clusters({JointSimulation::kMarkers, s.a_in_world},
                                {JointSimulation::kMarkers, s.b_in_world});
}

/// Returns the estimated centre in the frame of the true shape of the first cluster.
glm::dvec3 found_in_a(const JointSimulation& truth, const ClusterJoint& found) {
  const std::vector<double> even(truth.shape_in_a.size(), 1.0);
  return align(found.shape_a, truth.shape_in_a, even) * found.p_in_a;
}

TEST(JointBetweenClusters, IsExactWithoutNoise) {
  const JointSimulation s =
      simulate_joint({.cone_rad = 1.6, .frames = 100, .noise_m = 0.0});
  const auto found = find(s);
  ASSERT_TRUE(found);
  EXPECT_LT(glm::distance(found_in_a(s, *found), s.joint_in_a), 1e-6);
  EXPECT_LT(found->rms_m, 1e-6);
}

TEST(JointBetweenClusters, ErrorsAreAsLargeAsTheirSigmas) {
  double in_sigmas2 = 0.0;
  constexpr int kRuns = 8;
  for (int run = 0; run < kRuns; ++run) {
    const auto seed = static_cast<std::uint64_t>(100 + run);
    const JointSimulation s =
        simulate_joint({.cone_rad = 1.0, .frames = 120, .seed = seed});
    const auto found = find(s);
    ASSERT_TRUE(found);
    const double off_m = glm::distance(found_in_a(s, *found), s.joint_in_a);
    in_sigmas2 += off_m * off_m / (3.0 * found->sigma_a_m * found->sigma_a_m);
  }
  // 24 degrees of freedom: 1 on average, 99.9 % below 2.1.
  EXPECT_LT(in_sigmas2 / kRuns, 2.1);
  EXPECT_GT(in_sigmas2 / kRuns, 0.2);
}

TEST(JointBetweenClusters, SoftTissueAndDropoutsAreSeenThrough) {
  const JointSimulation s = simulate_joint({.cone_rad = 1.6,
                                            .frames = 200,
                                            .soft_tissue_m = 0.010,
                                            .dropouts = 0.2,
                                            .seed = 5});
  const auto found = find(s);
  ASSERT_TRUE(found);
  // A model of rigid clusters would place it some 10 mm off.
  EXPECT_LT(glm::distance(found_in_a(s, *found), s.joint_in_a), 0.005);
  EXPECT_NEAR(found->soft_tissue_b_m, 0.010, 0.003);
  EXPECT_LT(found->soft_tissue_a_m, 0.001);
}

TEST(JointBetweenClusters, ReportsALargeUncertaintyForASmallRotation) {
  const JointSimulation s = simulate_joint({.cone_rad = 0.02, .frames = 60, .seed = 3});
  const auto found = find(s);
  if (found) {
    EXPECT_GT(found->sigma_a_m, 0.005);
  }
}

TEST(JointBetweenClusters, DeclinesTooLittle) {
  JointSimulation s = simulate_joint({.frames = 15});
  EXPECT_FALSE(find(s));  // frames
  s = simulate_joint({.frames = 100});
  for (std::size_t i = 0; i < s.b_in_world.size(); ++i) {
    if (i % JointSimulation::kMarkers > 1) s.b_in_world[i].reset();
  }
  EXPECT_FALSE(find(s));  // two markers
}

TEST(JointBetweenClusters, DeclinesMarkersOnALine) {
  JointSimulation s = simulate_joint({.frames = 100, .noise_m = 0.0});
  for (std::size_t i = 0; i < s.a_in_world.size(); i += JointSimulation::kMarkers) {
    const glm::dvec3 first = *s.a_in_world[i];
    const glm::dvec3 along = *s.a_in_world[i + 1] - first;
    s.a_in_world[i + 2] = first + 0.3 * along;
    s.a_in_world[i + 3] = first + 0.7 * along;
  }
  EXPECT_FALSE(find(s));
}

}  // namespace
}  // namespace marey::reconstruct
