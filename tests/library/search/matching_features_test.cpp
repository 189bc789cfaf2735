// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/matching_features.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/library/moved_motion.h"

namespace marey::library {
namespace {

std::vector<float> matching_of(const Motion& motion) {
  const auto map = retarget::map_body(motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return matching_features(motion, *map);
}

// A stiff body on a circle to the left, at constant speed, facing along it.
Motion circling(double speed_m_per_s, double turn_rad_per_s, double hz, int frames) {
  const Skeleton body = make_humanoid(average_proportions(1.75));
  Motion motion{body, FrameRate{hz}, 0, {}};
  const double radius_m = speed_m_per_s / turn_rad_per_s;
  for (int n = 0; n < frames; ++n) {
    const double turn = turn_rad_per_s * n / hz;
    Pose pose = rest_pose(body);
    pose.root_in_world.x = radius_m * (1.0 - std::cos(turn));
    pose.root_in_world.z = radius_m * std::sin(turn);
    pose.parent_from_joint[0] = glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0));
    motion.poses.push_back(pose);
  }
  return motion;
}

TEST(MatchingFeatures, AreThoseOfACircle) {
  constexpr double kSpeed = 1.5;
  constexpr double kTurn = 0.8;
  const Motion motion = circling(kSpeed, kTurn, 60.0, 240);
  const std::vector<float> rows = matching_of(motion);
  ASSERT_EQ(rows.size(), 240U * kMatchingCount);
  const auto rest = world_from_joints(motion.skeleton, rest_pose(motion.skeleton));
  // The average of a circle's arc is inside of it, here by 13 mm.
  double inside_m = kSpeed / kTurn;
  for (int n = -15; n <= 15; ++n) {
    inside_m -= kSpeed / kTurn * std::cos(kTurn * n / 60.0) / 31.0;
  }
  for (std::size_t k = 30; k < 150; ++k) {
    const float* row = rows.data() + k * kMatchingCount;
    const glm::dvec3 left = rest[index(HumanBone::kLeftFoot)].translation;
    const glm::dvec3 hips = rest[index(HumanBone::kHips)].translation;
    EXPECT_NEAR(row[0], left.x - hips.x - inside_m, 1e-4);
    EXPECT_NEAR(row[1], left.y, 1e-5);
    EXPECT_NEAR(row[2], left.z - hips.z, 1e-4);
    EXPECT_LT(row[3], 0.0F);  // The right foot.
    EXPECT_NEAR(row[12], 0.0, 1e-3);
    EXPECT_NEAR(row[14], kSpeed, 1e-3);
    // The left foot is inside of the circle and slower.
    EXPECT_NEAR(row[8], kSpeed - kTurn * left.x, 1e-2);
    for (std::size_t a = 0; a < 3; ++a) {
      const double turn = kTurn * static_cast<double>(a + 1) / 3.0;
      const double radius = kSpeed / kTurn;
      EXPECT_NEAR(row[15 + 2 * a], radius * (1.0 - std::cos(turn)), 0.01);
      EXPECT_NEAR(row[16 + 2 * a], radius * std::sin(turn), 0.01);
      EXPECT_NEAR(row[21 + 2 * a], std::sin(turn), 1e-4);
      EXPECT_NEAR(row[22 + 2 * a], std::cos(turn), 1e-4);
    }
  }
}

TEST(MatchingFeatures, DoNotDependOnThePlaceOnTheFloor) {
  const Motion motion = random_motion(20, 120, 30.0);
  const std::vector<float> a = matching_of(motion);
  const std::vector<float> b = matching_of(moved(motion, 2.1, -5.0, 9.0));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-4);
}

TEST(MatchingFeatures, AfterTheEndAreTheLastFrame) {
  Motion motion = circling(1.0, 0.5, 30.0, 2);
  const std::vector<float> rows = matching_of(motion);
  for (std::size_t c : {15U, 16U, 17U, 18U, 19U, 20U}) {
    EXPECT_NEAR(rows[kMatchingCount + c], 0.0, 1e-6);
  }
  motion.poses.resize(1);
  const std::vector<float> one = matching_of(motion);
  ASSERT_EQ(one.size(), static_cast<std::size_t>(kMatchingCount));
  for (std::size_t c = 6; c < 21; ++c) EXPECT_EQ(one[c], 0.0F);
  motion.poses.clear();
  EXPECT_TRUE(matching_of(motion).empty());
}

// Two passes over all values, in one order.
TEST(MatchingStatistics, AreMeanAndWeightedDeviation) {
  const std::vector<float> a = matching_of(random_motion(21, 90, 30.0));
  const std::vector<float> b = matching_of(random_motion(22, 60, 30.0));
  MatchingStatistics statistics;
  statistics.add(a);
  statistics.add(b);
  const MatchingScale scale = statistics.scale();
  std::vector<float> all = a;
  all.insert(all.end(), b.begin(), b.end());
  const double count = static_cast<double>(all.size()) / kMatchingCount;
  std::array<double, kMatchingCount> deviation{};
  for (std::size_t c = 0; c < kMatchingCount; ++c) {
    double mean = 0.0;
    for (std::size_t k = c; k < all.size(); k += kMatchingCount) {
      mean += static_cast<double>(all[k]) / count;
    }
    for (std::size_t k = c; k < all.size(); k += kMatchingCount) {
      deviation[c] += (all[k] - mean) * (all[k] - mean) / count;
    }
    deviation[c] = std::sqrt(deviation[c]);
    EXPECT_NEAR(scale.offset[c], mean, 1e-5);
  }
  EXPECT_NEAR(
      scale.scale[0], (deviation[0] + deviation[1] + deviation[2]) / 3.0 / 0.75, 1e-4);
  EXPECT_NEAR(
      scale.scale[13], (deviation[12] + deviation[13] + deviation[14]) / 3.0, 1e-4);
  double facing = 0.0;
  for (std::size_t c = 21; c < 27; ++c) facing += deviation[c] / 6.0 / 1.5;
  EXPECT_NEAR(scale.scale[26], facing, 1e-4);
}

TEST(MatchingStatistics, LeaveValuesAsTheyAreWithoutVariation) {
  const MatchingScale none = MatchingStatistics().scale();
  MatchingStatistics still;
  still.add(std::vector<float>(3 * kMatchingCount, 2.0F));
  for (std::size_t c = 0; c < kMatchingCount; ++c) {
    EXPECT_EQ(none.offset[c], 0.0F);
    EXPECT_EQ(none.scale[c], 1.0F);
    EXPECT_EQ(still.scale().scale[c], 1.0F);
  }
}

}  // namespace
}  // namespace marey::library
