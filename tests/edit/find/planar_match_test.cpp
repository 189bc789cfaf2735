// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/planar_match.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "retarget/body/body_map.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

using testing::Dice;

struct PlanarCloud {
  std::vector<glm::dvec3> a;
  std::vector<glm::dvec3> b;
  std::vector<double> weights;
};

PlanarCloud random_cloud(Dice& dice, int count, double noise_m) {
  PlanarCloud cloud;
  const PlanarMove truth{dice.noise(2.0), {dice.noise(5.0), dice.noise(5.0)}};
  for (int k = 0; k < count; ++k) {
    cloud.b.emplace_back(dice.noise(0.5), 1.0 + dice.noise(0.5), dice.noise(0.5));
    cloud.a.push_back(truth(cloud.b.back()) + glm::dvec3(dice.noise(noise_m),
                                                         dice.noise(noise_m),
                                                         dice.noise(noise_m)));
    cloud.weights.push_back(std::abs(dice.noise(1.0)) + 0.01);
  }
  return cloud;
}

double cost(const PlanarCloud& cloud, const PlanarMove& move) {
  double sum = 0.0;
  for (std::size_t k = 0; k < cloud.a.size(); ++k) {
    const glm::dvec3 off = cloud.a[k] - move(cloud.b[k]);
    sum += cloud.weights[k] * glm::dot(off, off);
  }
  return sum;
}

// Scans the turn, with the best shift of each, and halves the step around the best.
double least_cost_by_search(const PlanarCloud& cloud) {
  const double total = std::accumulate(cloud.weights.begin(), cloud.weights.end(), 0.0);
  const auto at_turn = [&](double turn_rad) {
    PlanarMove move{turn_rad, {0.0, 0.0}};
    glm::dvec3 shift(0.0);
    for (std::size_t k = 0; k < cloud.a.size(); ++k) {
      shift += cloud.weights[k] / total * (cloud.a[k] - move(cloud.b[k]));
    }
    move.shift_xz_m = {shift.x, shift.z};
    return cost(cloud, move);
  };
  double best = 0.0;
  double best_cost = at_turn(0.0);
  for (double step = 0.1, from = -3.2; step > 1e-9; step *= 0.5) {
    for (double turn = from; turn <= from + (step > 0.06 ? 6.4 : 4 * step);
         turn += step) {
      if (at_turn(turn) < best_cost) {
        best = turn;
        best_cost = at_turn(turn);
      }
    }
    from = best - step;
  }
  return best_cost;
}

TEST(FitPlanar, RecoversAnyMoveExactly) {
  Dice dice(11);
  for (int n = 0; n < 50; ++n) {
    const PlanarCloud cloud = random_cloud(dice, 12, 0.0);
    EXPECT_LT(cost(cloud, fit_planar(cloud.a, cloud.b, cloud.weights)), 1e-24);
  }
}

TEST(FitPlanar, IsAsGoodAsASearchOverAllTurns) {
  Dice dice(12);
  for (int n = 0; n < 40; ++n) {
    const PlanarCloud cloud = random_cloud(dice, 15, n % 2 == 0 ? 0.05 : 0.5);
    const double closed = cost(cloud, fit_planar(cloud.a, cloud.b, cloud.weights));
    const double searched = least_cost_by_search(cloud);
    EXPECT_LE(closed, searched * (1 + 1e-12));
    EXPECT_GE(closed, searched * (1 - 1e-9));
  }
}

TEST(FitPlanar, DoesNotTurnPointsOnOneVertical) {
  const std::vector<glm::dvec3> a{{1, 0, 2}, {1, 1, 2}};
  const std::vector<glm::dvec3> b{{3, 0, 4}, {3, 1, 4}};
  const std::vector<double> weights{1.0, 2.0};
  const PlanarMove move = fit_planar(a, b, weights);
  EXPECT_EQ(move.turn_rad, 0.0);
  EXPECT_DOUBLE_EQ(move.shift_xz_m.x, -2.0);
  EXPECT_DOUBLE_EQ(move.shift_xz_m.y, -2.0);
}

TEST(PlanarMove, ComposesAndInverts) {
  const PlanarMove a{0.7, {1.0, -2.0}};
  const PlanarMove b{-2.1, {0.3, 5.0}};
  const glm::dvec3 p(0.2, 1.5, -3.0);
  EXPECT_LT(glm::distance((a * b)(p), a(b(p))), 1e-14);
  EXPECT_LT(glm::distance((inverse(a) * a)(p), p), 1e-14);
  EXPECT_LT(glm::distance(power(a, 3)(p), a(a(a(p)))), 1e-13);
  EXPECT_LT(glm::distance(power(a, -2)(a(a(p))), p), 1e-13);
}

TEST(PlanarMove, MovesAPoseAsItsJoints) {
  Motion motion = testing::synthetic_walk(1, 30.0).motion;
  const auto before = world_from_joints(motion.skeleton, motion.poses[0]);
  const PlanarMove move{1.1, {2.0, -0.5}};
  move_pose(move, motion.poses[0]);
  const auto after = world_from_joints(motion.skeleton, motion.poses[0]);
  for (std::size_t j = 0; j < before.size(); ++j) {
    EXPECT_LT(glm::distance(after[j].translation, move(before[j].translation)), 1e-14);
  }
}

TEST(MatchPoints, WeighJointsByTheMassOfTheirSegments) {
  const Motion motion = testing::synthetic_walk(3, 30.0).motion;
  const auto map = retarget::map_body(motion.skeleton);
  ASSERT_TRUE(map);
  const std::vector<double> share = joint_mass_shares(motion.skeleton, *map);
  EXPECT_NEAR(std::accumulate(share.begin(), share.end(), 0.0), 1.0, 1e-12);
  const auto of = [&](HumanBone bone) {
    return share[index(*motion.skeleton.find(bone))];
  };
  EXPECT_DOUBLE_EQ(of(HumanBone::kLeftFoot), of(HumanBone::kRightFoot));
  EXPECT_GT(of(HumanBone::kLeftLowerLeg), of(HumanBone::kLeftFoot));
  EXPECT_GT(of(HumanBone::kLeftFoot), of(HumanBone::kLeftToes));
  EXPECT_GT(of(HumanBone::kLeftToes), 0.0);
}

TEST(MatchWindows, FindTheMoveBetweenTwoCopies) {
  const Motion walk = testing::synthetic_walk(40, 30.0, 0.02, 0.005).motion;
  const auto map = retarget::map_body(walk.skeleton);
  ASSERT_TRUE(map);
  Motion moved = walk;
  const PlanarMove move{-0.9, {4.0, 1.0}};
  for (Pose& pose : moved.poses) move_pose(move, pose);
  const MatchPoints a = match_points(walk, *map);
  const MatchPoints b = match_points(moved, *map);
  for (const int frame : {0, 1, 20, 39}) {
    const PlanarMatch match = match_windows(a, frame, b, frame);
    EXPECT_LT(match.distance_m, 1e-12);
    EXPECT_NEAR(match.a_from_b.turn_rad, 0.9, 1e-12);
  }
  EXPECT_GT(match_windows(a, 10, b, 25).distance_m, 0.05);
}

TEST(MatchWindows, CountsVelocities) {
  // The same postures, in the opposite order: a window of one frame has no gap.
  const Motion walk = testing::synthetic_walk(30, 30.0).motion;
  Motion reversed = walk;
  for (std::size_t k = 0; k < walk.poses.size(); ++k) {
    reversed.poses[k] = walk.poses[walk.poses.size() - 1 - k];
  }
  const auto map = retarget::map_body(walk.skeleton);
  ASSERT_TRUE(map);
  const MatchPoints a = match_points(walk, *map);
  const MatchPoints b = match_points(reversed, *map);
  const PlanarMatch match = match_windows(a, 10, b, 19, {.half_window = 0});
  EXPECT_LT(match.rms_m, 1e-12);
  EXPECT_GT(match.rms_velocity_m_per_s, 1.0);
  EXPECT_NEAR(match.distance_m, 0.1 * match.rms_velocity_m_per_s, 1e-12);
}

}  // namespace
}  // namespace marey::edit
