// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/find_loops.h"

#include <cmath>
#include <vector>

#include "edit/find/loop_cost.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "tests/edit/varied_walk.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::edit {
namespace {

EditState loop_state(Motion motion) {
  auto state = make_edit_state(std::move(motion));
  EXPECT_TRUE(state);
  return std::move(*state);
}

// Stands with a trembling body; from `kick_s` on the right leg swings up once.
Motion standing(double duration_s, double noise_rad, double kick_s = -1.0) {
  Motion motion = varied_walk({.duration_s = duration_s}).motion;
  testing::Dice dice(8);
  const Pose rest = rest_pose(motion.skeleton);
  for (std::size_t n = 0; n < motion.poses.size(); ++n) {
    Pose& pose = motion.poses[n];
    pose = rest;
    const double share = (static_cast<double>(n) / motion.rate.hz - kick_s) / 0.8;
    if (kick_s >= 0.0 && share > 0.0 && share < 1.0) {
      const double lift = 1.4 * std::pow(std::sin(3.14159265 * share), 2);
      pose.parent_from_joint[index(HumanBone::kRightUpperLeg)] =
          glm::angleAxis(-lift, glm::dvec3(1, 0, 0));
    }
    for (glm::dquat& q : pose.parent_from_joint) {
      q = q * rotation_from_vector(
                  {dice.noise(noise_rad), dice.noise(noise_rad), dice.noise(noise_rad)});
    }
  }
  return motion;
}

TEST(FindLoops, RecoversPeriodAndTravelOfTurningWalks) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const VariedWalk walk = varied_walk(random_walk_options(seed));
    const EditState state = loop_state(walk.motion);
    const auto loops = find_loops(state);
    ASSERT_FALSE(loops.empty()) << "seed " << seed;
    const LoopCandidate& best = loops.front();
    // An eighth of a frame at 30 Hz.
    EXPECT_NEAR(best.period_frames / walk.motion.rate.hz, walk.period_s, 0.004)
        << "seed " << seed;
    EXPECT_NEAR(best.travel.turn_rad, walk.travel.turn_rad, 0.004) << "seed " << seed;
    const auto first = static_cast<std::size_t>(best.first);
    const glm::dvec3 root = walk.motion.poses[first].root_in_world;
    EXPECT_LT(glm::distance(best.travel(root), walk.travel(root)), 0.005)
        << "seed " << seed;
  }
}

TEST(FindLoops, RecoversThemUnderNoise) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    VariedWalkOptions options = random_walk_options(seed);
    options.noise_rad = 0.005;
    options.noise_m = 0.002;
    const VariedWalk walk = varied_walk(options);
    const auto loops = find_loops(loop_state(walk.motion));
    ASSERT_FALSE(loops.empty()) << "seed " << seed;
    EXPECT_NEAR(loops.front().period_frames / walk.motion.rate.hz, walk.period_s, 0.015)
        << "seed " << seed;
    EXPECT_NEAR(loops.front().travel.turn_rad, walk.travel.turn_rad, 0.02)
        << "seed " << seed;
  }
}

TEST(FindLoops, DeclinesABodyThatStands) {
  const EditState state = loop_state(standing(6.0, 0.002));
  EXPECT_FALSE(foot_period(state.motion, state.map, {0, state.frame_count() - 1}));
  EXPECT_TRUE(find_loops(state).empty());
}

TEST(FindLoops, DeclinesASingleKick) {
  EXPECT_TRUE(find_loops(loop_state(standing(4.0, 0.002, 1.5))).empty());
}

TEST(FindLoops, LeavesOutARestBeforeTheWalk) {
  Motion motion = varied_walk({.duration_s = 6.0}).motion;
  const Pose first = motion.poses.front();
  motion.poses.insert(motion.poses.begin(), 180, first);
  const auto loops = find_loops(loop_state(std::move(motion)));
  ASSERT_FALSE(loops.empty());
  for (const LoopCandidate& loop : loops) EXPECT_GT(loop.last, 180 + 20);
  EXPECT_GE(loops.front().first, 170);
}

TEST(FindLoops, StaysWithinPeriodsAndFramesGiven) {
  const EditState state = loop_state(varied_walk({.duration_s = 6.0}).motion);
  FindLoopsOptions options;
  options.min_period_s = 2.0;
  options.max_period_s = 2.4;
  options.within = FrameRange{30, 300};
  const auto loops = find_loops(state, options);
  ASSERT_FALSE(loops.empty());
  for (const LoopCandidate& loop : loops) {
    EXPECT_GE(loop.first, 30);
    EXPECT_LE(loop.last, 300);
    EXPECT_GE(loop.last - loop.first, 120);
    EXPECT_LE(loop.last - loop.first, 144);
  }
  EXPECT_NEAR(loops.front().period_frames, 2.2 * 60, 0.5);
}

TEST(FindLoops, PrefersStrikesIfAsked) {
  VariedWalkOptions walk;
  walk.noise_m = 0.002;
  const EditState state = loop_state(varied_walk(walk).motion);
  FindLoopsOptions options;
  options.strike_preference = 100.0;
  const auto loops = find_loops(state, options);
  ASSERT_FALSE(loops.empty());
  EXPECT_NE(loops.front().edge, LoopEdge::kNone);
}

TEST(FindLoops, GivesNothingForTheShortestMotions) {
  Motion motion = varied_walk({.duration_s = 1.0}).motion;
  motion.poses.resize(1);
  EXPECT_TRUE(find_loops(loop_state(motion)).empty());
  motion.poses.resize(3, motion.poses.front());
  EXPECT_TRUE(find_loops(loop_state(motion)).empty());
}

TEST(LoopCost, AgreesWithTheDistanceOfWindows) {
  // A body of five joints with mass cannot be had: the same five joints, compared by
  // match_windows() with the weights of all others at 0.
  const VariedWalk walk = varied_walk({.duration_s = 1.5, .noise_m = 0.01});
  const EditState state = loop_state(walk.motion);
  MatchPoints points = match_points(state.motion, state.map);
  std::vector<double> weights(points.weights.size(), 0.0);
  const std::vector<double> shares = joint_mass_shares(state.motion.skeleton, state.map);
  std::size_t point = 0;
  double total = 0.0;
  for (std::size_t j = 0; j < shares.size(); ++j) {
    if (shares[j] <= 0.0) continue;
    const auto bone = *state.motion.skeleton.joints[j].bone;
    if (bone == HumanBone::kHips) weights[point] = 0.5;
    if (bone == HumanBone::kLeftFoot || bone == HumanBone::kRightFoot) {
      weights[point] = 0.2;
    }
    if (bone == HumanBone::kLeftHand || bone == HumanBone::kRightHand) {
      weights[point] = 0.05;
    }
    total += weights[point];
    ++point;
  }
  EXPECT_NEAR(total, 1.0, 1e-12);
  points.weights = weights;
  LoopCost cost(state.motion, state.map, {});
  std::vector<double> row(static_cast<std::size_t>(cost.frame_count() - 40));
  cost.squared_distances(40, row);
  for (const int k : {0, 1, 17, cost.frame_count() - 41}) {
    const double distance = match_windows(points, k + 40, points, k).distance_m;
    EXPECT_NEAR(std::sqrt(row[static_cast<std::size_t>(k)]), distance, 1e-9) << k;
  }
}

TEST(LoopMap, IsLowestOnePeriodFromTheDiagonal) {
  const EditState state = loop_state(varied_walk({.duration_s = 5.5}).motion);
  const LoopMap map = loop_map(state, 100);
  ASSERT_GT(map.cells, 50);
  const auto at = [&](int row, int column) {
    return map.distance_m[static_cast<std::size_t>(row * map.cells + column)];
  };
  const int period = 66 / map.cell_frames;
  EXPECT_LT(at(5, 5 + period), 0.01F);
  EXPECT_GT(at(5, 5 + period / 2), 0.1F);
  EXPECT_EQ(at(5, 2), 0.0F);
}

}  // namespace
}  // namespace marey::edit
