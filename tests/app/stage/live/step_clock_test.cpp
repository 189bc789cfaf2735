// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/step_clock.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

using namespace std::chrono_literals;

TEST(StepClock, MakesNoStepBeforeItsTime) {
  StepClock clock(60.0, 10);
  clock.start(5s);
  EXPECT_EQ(clock.take_due(5s), 0);
  EXPECT_EQ(clock.next(), 5s + Timestamp(16'666'667));
  EXPECT_EQ(clock.take_due(5s + Timestamp(16'666'666)), 0);
  EXPECT_EQ(clock.take_due(5s + Timestamp(16'666'667)), 1);
  EXPECT_EQ(clock.take_due(5s + Timestamp(16'666'667)), 0);
}

TEST(StepClock, MakesNoStepIfTimeGoesBack) {
  StepClock clock(60.0, 10);
  clock.start(5s);
  EXPECT_EQ(clock.take_due(5s + 100ms), 6);
  EXPECT_EQ(clock.take_due(5s + 50ms), 0);
  EXPECT_EQ(clock.take_due(4s), 0);
  EXPECT_EQ(clock.take_due(5s + 117ms), 1);
}

// Calls come at random times that are never further apart than the limit.
TEST(StepClock, HasNoDriftOverAnHour) {
  for (const double rate_hz : {30.0, 59.94, 60.0, 120.0, 1000.0}) {
    StepClock clock(rate_hz, 100);
    clock.start(7ns);
    std::mt19937 random(3);
    std::int64_t steps = 0;
    Timestamp now = 7ns;
    while (now < 1h) {
      now += Timestamp(static_cast<std::int64_t>(random() % 50'000'000));
      steps += clock.take_due(now);
      const double due = static_cast<double>((now - 7ns).count()) * rate_hz / 1e9;
      ASSERT_LE(static_cast<double>(steps), due + 1e-3);
      ASSERT_GT(static_cast<double>(steps), due - 1.001);
    }
    EXPECT_EQ(clock.skipped(), 0);
  }
}

TEST(StepClock, SkipsStepsBeyondTheLimitAfterADelay) {
  StepClock clock(50.0, 4);
  clock.start(0s);
  EXPECT_EQ(clock.take_due(2s), 4);
  EXPECT_EQ(clock.skipped(), 96);
  // The phase of the steps is kept.
  EXPECT_EQ(clock.next(), 2020ms);
  EXPECT_EQ(clock.take_due(2019ms), 0);
  EXPECT_EQ(clock.take_due(2020ms), 1);
}

TEST(StepClock, CountsNothingDuringAPause) {
  StepClock clock(50.0, 4);
  clock.start(0s);
  EXPECT_EQ(clock.take_due(40ms), 2);
  clock.start(10s);
  EXPECT_EQ(clock.take_due(10s + 19ms), 0);
  EXPECT_EQ(clock.take_due(10s + 20ms), 1);
  EXPECT_EQ(clock.skipped(), 0);
}

}  // namespace
}  // namespace marey::app
