// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/time.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(FrameTime, IsTheFrameOverTheRatePlusTheOffset) {
  EXPECT_EQ(frame_time(30, {30.0}), Timestamp{1'000'000'000});
  EXPECT_EQ(frame_time(3, {60.0}, Timestamp{7}), Timestamp{50'000'007});
  EXPECT_EQ(frame_time(-1, {10.0}), Timestamp{-100'000'000});
}

TEST(FrameTime, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(frame_time(1, {30.0}), Timestamp{33'333'333});
  EXPECT_EQ(frame_time(2, {30.0}), Timestamp{66'666'667});
}

TEST(FrameTime, DoesNotDriftOverAnHourOfNtsc) {
  // Counted, not added up: an hour of 30000/1001 Hz ends within half a nanosecond.
  const FrameRate ntsc{30000.0 / 1001.0};
  EXPECT_EQ(frame_time(30000, ntsc), Timestamp{1'001'000'000'000});
  EXPECT_EQ(frame_time(90000, ntsc), Timestamp{3'003'000'000'000});
}

TEST(FromSeconds, IsUndoneBySeconds) {
  for (const double time_s : {0.0, 0.0073, -0.0111, 3600.0}) {
    EXPECT_NEAR(seconds(from_seconds(time_s)), time_s, 0.5e-9);
  }
}

}  // namespace
}  // namespace marey
