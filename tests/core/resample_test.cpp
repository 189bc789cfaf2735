// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/resample.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey {
namespace {

constexpr double kNtscHz = 30000.0 / 1001.0;

/// The root on a straight line, and a spine that turns steadily, faster than a turn a
/// second, so that its quaternion passes through both signs.
Motion steady(FrameRate rate, int frames, int first_frame = 0) {
  Motion motion;
  motion.skeleton.joints.resize(2);
  motion.skeleton.joints[1].parent = JointIndex{0};
  motion.rate = rate;
  motion.first_frame = first_frame;
  for (int i = 0; i < frames; ++i) {
    const double time_s = (first_frame + i) / rate.hz;
    glm::dquat turned = glm::angleAxis(7.0 * time_s, glm::dvec3(0, 1, 0));
    if (i % 2 == 1) turned = -turned;
    motion.poses.push_back({{time_s, 1.0, 0.0}, {glm::dquat(1, 0, 0, 0), turned}});
  }
  return motion;
}

void expect_same_bits(const Pose& a, const Pose& b) {
  EXPECT_EQ(a.root_in_world, b.root_in_world);
  EXPECT_EQ(a.parent_from_joint, b.parent_from_joint);
}

TEST(Resample, KeepsEveryInstantThatBothRatesShareToTheBit) {
  const Motion motion = steady({120.0}, 481);
  const Motion slower = resample(motion, {30.0});
  ASSERT_EQ(slower.poses.size(), 121U);
  EXPECT_EQ(slower.rate.hz, 30.0);
  for (std::size_t i = 0; i < slower.poses.size(); ++i) {
    expect_same_bits(slower.poses[i], motion.poses[4 * i]);
  }
  const Motion again = resample(resample(motion, {240.0}), {120.0});
  ASSERT_EQ(again.poses.size(), motion.poses.size());
  for (std::size_t i = 0; i < again.poses.size(); ++i) {
    expect_same_bits(again.poses[i], motion.poses[i]);
  }
}

TEST(Resample, GivesTheSameMotionAtItsOwnRate) {
  for (const double hz : {29.97, kNtscHz, 60.0, 119.88}) {
    const Motion motion = steady({hz}, 1000, 17);
    const Motion same = resample(motion, {hz});
    EXPECT_EQ(same.first_frame, 17);
    ASSERT_EQ(same.poses.size(), motion.poses.size());
    for (std::size_t i = 0; i < same.poses.size(); ++i) {
      expect_same_bits(same.poses[i], motion.poses[i]);
    }
  }
}

TEST(Resample, FollowsSteadyMovementBetweenFrames) {
  for (const double hz : {24.0, 29.97, 50.0, 90.0, 100.0, 1000.0}) {
    const Motion motion = steady({60.0}, 121, 30);
    const Motion other = resample(motion, {hz});
    for (std::size_t i = 0; i < other.poses.size(); ++i) {
      const double time_s = (other.first_frame + static_cast<double>(i)) / hz;
      EXPECT_NEAR(other.poses[i].root_in_world.x, time_s, 1e-7);
      const glm::dquat truth = glm::angleAxis(7.0 * time_s, glm::dvec3(0, 1, 0));
      EXPECT_NEAR(
          std::abs(glm::dot(other.poses[i].parent_from_joint[1], truth)), 1, 1e-12);
    }
  }
}

// Three hours at NTSC's rate: the last instants are as near to their frames as the first.
TEST(Resample, DoesNotDriftOverHours) {
  const Motion motion = steady({kNtscHz}, 323677);
  const Motion other = resample(motion, {30.0});
  const double last_s = 323676 / kNtscHz;
  ASSERT_EQ(other.poses.size(), static_cast<std::size_t>(std::floor(last_s * 30.0)) + 1);
  for (std::size_t i = 0; i < other.poses.size(); i += 1001) {
    EXPECT_NEAR(other.poses[i].root_in_world.x, static_cast<double>(i) / 30.0, 1e-7);
  }
}

TEST(Resample, IsAsLongAsTheMotion) {
  for (const int first : {0, 1, 5, 119}) {
    for (const int frames : {1, 2, 4, 5, 241}) {
      const Motion other = resample(steady({120.0}, frames, first), {25.0});
      const double from_s = first / 120.0;
      const double to_s = (first + frames - 1) / 120.0;
      const auto count = static_cast<double>(other.poses.size());
      if (count == 0.0) continue;
      // All of its instants lie within, and none more would.
      EXPECT_GE(other.first_frame / 25.0, from_s - 1e-8);
      EXPECT_LT((other.first_frame - 1) / 25.0, from_s);
      EXPECT_LE((other.first_frame + count - 1) / 25.0, to_s + 1e-8);
      EXPECT_GT((other.first_frame + count) / 25.0, to_s);
    }
  }
}

TEST(Resample, HasNoPosesWhereNoInstantFalls) {
  EXPECT_TRUE(resample(steady({120.0}, 0), {30.0}).poses.empty());
  EXPECT_TRUE(resample(steady({120.0}, 2, 1), {30.0}).poses.empty());
  EXPECT_EQ(resample(steady({120.0}, 1, 4), {30.0}).poses.size(), 1U);
}

}  // namespace
}  // namespace marey
