// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/angular_momentum.h"

#include <algorithm>
#include <cmath>

#include "dynamics/momentum/posed_masses.h"
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "tests/dynamics/momentum/made_flight.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey::dynamics {
namespace {

using testing::Dice;
using testing::Differences;

double largest_difference(const glm::dmat3& a, const glm::dmat3& b) {
  double largest = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
  }
  return largest;
}

TEST(CentroidalStates, AgreeWithTheJudge) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(8000 + seed);
    const MadeFlight flight =
        made_flight(dice, {.frames = 15, .max_swing_rad = 1.0, .turns = 0.3});
    const auto states =
        centroidal_states(flight.skeleton, flight.masses, flight.rate, flight.poses);
    const auto judged = testing::judged_momentum(flight.skeleton,
                                                 flight.masses,
                                                 flight.rate.hz,
                                                 flight.poses,
                                                 Differences::kThreePoint);
    ASSERT_EQ(states.size(), judged.size() + 2);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const Pose& pose = flight.poses[k];
      EXPECT_LT(glm::distance(states[k].com_in_world,
                              testing::judged_com(flight.skeleton, flight.masses, pose)),
                1e-12);
      EXPECT_LT(largest_difference(
                    states[k].inertia_kg_m2,
                    testing::judged_inertia(flight.skeleton, flight.masses, pose)),
                1e-10);
      if (k == 0 || k + 1 == states.size()) continue;
      EXPECT_LT(glm::distance(states[k].angular_momentum_kg_m2_s, judged[k - 1]), 1e-9);
    }
  }
}

// A rigid body that turns steadily has L = I omega; central differences shorten the steps
// of its points by (omega h)^2 / 6.
TEST(CentroidalStates, GiveInertiaTimesAngularVelocityOfARigidBody) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(8200 + seed);
    MadeFlight flight = made_flight(dice, {.frames = 3, .max_swing_rad = 0.0});
    const glm::dvec3 omega = dice.between(0.1, 6.0) * dice.direction();
    const Pose pose = testing::random_pose(flight.skeleton, dice);
    const glm::dvec3 velocity = 3.0 * dice.direction();
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = (static_cast<double>(k) - 1.0) / 120.0;
      const glm::dquat turn = rotation_from_vector(t * omega);
      flight.poses[k] = pose;
      flight.poses[k].root_in_world = turn * pose.root_in_world + t * velocity;
      flight.poses[k].parent_from_joint[0] = turn * pose.parent_from_joint[0];
    }
    const CentroidalState state =
        centroidal_states(flight.skeleton, flight.masses, flight.rate, flight.poses)[1];
    const glm::dvec3 wanted = state.inertia_kg_m2 * omega;
    const double step_rad = glm::length(omega) / 120.0;
    EXPECT_LT(glm::distance(state.angular_momentum_kg_m2_s, wanted),
              (step_rad * step_rad / 6.0 + 1e-9) * 100.0);
  }
}

// The velocity of the whole does not count, also at the ends with one-sided differences.
TEST(CentroidalStates, GiveNoAngularMomentumToAStraightMotion) {
  Dice dice(8400);
  MadeFlight flight = made_flight(dice, {.frames = 10, .max_swing_rad = 0.0});
  for (const CentroidalState& state :
       centroidal_states(flight.skeleton, flight.masses, flight.rate, flight.poses)) {
    EXPECT_LT(glm::length(state.angular_momentum_kg_m2_s), 1e-9);
  }
}

TEST(CentroidalStates, AcceptOnePoseAndNone) {
  Dice dice(8401);
  MadeFlight flight = made_flight(dice, {.frames = 2});
  flight.poses.resize(1);
  const auto one =
      centroidal_states(flight.skeleton, flight.masses, flight.rate, flight.poses);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].angular_momentum_kg_m2_s, glm::dvec3(0.0));
  EXPECT_GT(one[0].inertia_kg_m2[0][0], 0.0);
  EXPECT_TRUE(centroidal_states(flight.skeleton, flight.masses, flight.rate, {}).empty());
}

TEST(QuickRotationVector, IsTheRotationVector) {
  Dice dice(8402);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 wanted = std::pow(10.0, dice.between(-6.0, 0.49)) * dice.direction();
    glm::dquat q = rotation_from_vector(wanted);
    if (i % 2 == 0) q = -q;
    EXPECT_LT(glm::distance(quick_rotation_vector(q), wanted), 1e-13 * (1.0 + 10.0));
  }
}

}  // namespace
}  // namespace marey::dynamics
