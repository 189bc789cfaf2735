// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/heard_motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

Skeleton one_joint() {
  Skeleton skeleton;
  skeleton.joints.emplace_back().name = "hips";
  return skeleton;
}

/// Turns by 1 rad/s about Y and moves by 2 m/s along X.
Pose at(double time_s) {
  Pose pose;
  pose.root_in_world = {2.0 * time_s, 1.0, 0.0};
  pose.parent_from_joint = {
      {std::cos(0.5 * time_s), 0.0, std::sin(0.5 * time_s), 0.0}};
  return pose;
}

TEST(HeardMotion, IsTheMovementAtAnyRateHoweverUnevenlyItCame) {
  HeardMotion heard;
  for (int i = 0; i <= 40; ++i) {
    // The first and the last in time; the others late by up to 8 ms.
    const double time_s = 0.05 * i + (i == 40 ? 0 : i % 3) * 0.004;
    heard.add(5.0 + time_s, at(time_s));
  }
  const auto motion = heard.at_rate(one_joint(), {30.0});
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->poses.size(), 61U);
  for (std::size_t f = 0; f < motion->poses.size(); ++f) {
    const Pose expected = at(static_cast<double>(f) / 30.0);
    EXPECT_NEAR(motion->poses[f].root_in_world.x, expected.root_in_world.x, 1e-9) << f;
    EXPECT_NEAR(motion->poses[f].parent_from_joint[0].y,
                expected.parent_from_joint[0].y,
                1e-9)
        << f;
  }
}

TEST(HeardMotion, GoesOnWhenTheSenderBeginsAnewAndPassesOverTheRest) {
  HeardMotion heard;
  heard.add(100.0, at(0.0));
  heard.add(100.1, at(0.1));
  heard.add(100.1, at(0.1));
  heard.add(100.05, at(0.05));
  EXPECT_EQ(heard.size(), 2U);
  heard.add(0.0, at(0.2));
  heard.add(0.1, at(0.3));
  EXPECT_EQ(heard.size(), 4U);
  const auto motion = heard.at_rate(one_joint(), {10.0});
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->poses.size(), 3U);
}

TEST(HeardMotion, IsNoneOfOnePose) {
  HeardMotion heard;
  EXPECT_FALSE(heard.at_rate(one_joint(), {30.0}));
  heard.add(0.0, at(0.0));
  EXPECT_FALSE(heard.at_rate(one_joint(), {30.0}));
}

}  // namespace
}  // namespace marey::app
