// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/motion_resampler.h"

#include <cmath>

#include <gtest/gtest.h>

#include "live/vmc/sender_clock.h"

namespace marey::live {
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
  pose.parent_from_joint = {{std::cos(0.5 * time_s), 0.0, std::sin(0.5 * time_s), 0.0}};
  return pose;
}

TEST(MotionResampler, IsTheMovementAtAnyRateHoweverUnevenlyItCame) {
  MotionResampler received;
  for (int i = 0; i <= 40; ++i) {
    // The first and the last in time; the others late by up to 8 ms.
    const double time_s = 0.05 * i + (i == 40 ? 0 : i % 3) * 0.004;
    received.add(5.0 + time_s, at(time_s));
  }
  const auto motion = received.at_rate(one_joint(), {30.0});
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->poses.size(), 61U);
  for (std::size_t f = 0; f < motion->poses.size(); ++f) {
    const Pose expected = at(static_cast<double>(f) / 30.0);
    EXPECT_NEAR(motion->poses[f].root_in_world.x, expected.root_in_world.x, 1e-9) << f;
    EXPECT_NEAR(
        motion->poses[f].parent_from_joint[0].y, expected.parent_from_joint[0].y, 1e-9)
        << f;
  }
}

TEST(MotionResampler, PassesOverWhatDoesNotGoOn) {
  MotionResampler received;
  received.add(100.0, at(0.0));
  received.add(100.1, at(0.1));
  received.add(100.1, at(0.1));
  received.add(100.05, at(0.05));
  EXPECT_EQ(received.size(), 2U);
  received.add(100.2, at(0.2));
  const auto motion = received.at_rate(one_joint(), {10.0});
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->poses.size(), 3U);
}

// Adds two seconds of packets. The sender's time jumps in the middle packet only, or in
// all packets after it as well. The motion keeps its length, and jumps above 1 s lose no
// packet.
TEST(MotionResampler, KeepsTheReceivedDurationWhenSenderTimesJump) {
  for (const double jump_s : {-5.0, 5.0, 0.9, 3e6, -3e6, 1e30, -1e30, 1.7e308}) {
    for (const bool stays : {false, true}) {
      SenderClock clock;
      MotionResampler received;
      for (int i = 0; i <= 60; ++i) {
        const double time_s = i / 30.0;
        const bool elsewhere = i == 30 || (stays && i > 30);
        const double said_s = 1000.0 + time_s + (elsewhere ? jump_s : 0.0);
        const double at_s = clock.at_s(said_s, 7.0 + time_s);
        EXPECT_NEAR(at_s, 7.0 + time_s, SenderClock::kMaxOffset_s) << jump_s;
        received.add(at_s, at(time_s));
      }
      EXPECT_GE(received.size(), std::abs(jump_s) > 1.0 ? 61U : 30U) << jump_s;
      const auto motion = received.at_rate(one_joint(), {30.0});
      ASSERT_TRUE(motion);
      EXPECT_NEAR(static_cast<double>(motion->poses.size()), 61.0, 30.0) << jump_s;
    }
  }
}

// The first frame selects the clock for all frames: the sender's or the receiver's.
TEST(MotionResampler, IsOnTheClockThatTheFirstFrameDecides) {
  SenderClock silent;
  EXPECT_EQ(silent.at_s(std::nullopt, 2.0), 2.0);
  EXPECT_EQ(silent.at_s(500.0, 2.1), 2.1);
  SenderClock telling;
  EXPECT_EQ(telling.at_s(500.0, 2.0), 2.0);
  EXPECT_NEAR(telling.at_s(500.1, 2.15), 2.1, 1e-12) << "50 ms late";
  EXPECT_NEAR(telling.at_s(std::nullopt, 2.25), 2.2, 1e-12) << "as late as the last one";
  EXPECT_NEAR(telling.at_s(500.3, 2.3), 2.3, 1e-12);
}

TEST(MotionResampler, ReturnsNothingForOnePose) {
  MotionResampler received;
  EXPECT_FALSE(received.at_rate(one_joint(), {30.0}));
  received.add(0.0, at(0.0));
  EXPECT_FALSE(received.at_rate(one_joint(), {30.0}));
}

}  // namespace
}  // namespace marey::live
