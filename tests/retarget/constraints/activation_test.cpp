// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/activation.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace marey::retarget {
namespace {

Activation between(double start_s, double stop_s, double in_s, double out_s) {
  return {start_s, stop_s, in_s, out_s};
}

TEST(Activation, IsFullForEverWithoutTimes) {
  for (const double t : {-1e9, 0.0, 1e9}) EXPECT_EQ(activation({}, t), 1.0);
}

// Annex A's constraint: off before its start, full from start + duration to stop, off
// from stop + duration on.
TEST(Activation, FollowsTheFigureWhereRampsDoNotOverlap) {
  const Activation parry = between(0.499995, 0.799992, 0.119999, 0.122574);
  EXPECT_EQ(activation(parry, 0.49), 0.0);
  EXPECT_EQ(activation(parry, 0.499995), 0.0);
  EXPECT_EQ(activation(parry, 0.62), 1.0);
  EXPECT_EQ(activation(parry, 0.799992), 1.0);
  EXPECT_EQ(activation(parry, 0.93), 0.0);
  // The quintic is symmetric: half way up at half the time, up to the times' rounding.
  EXPECT_NEAR(activation(parry, 0.499995 + 0.119999 / 2), 0.5, 1e-14);
  EXPECT_NEAR(activation(parry, 0.799992 + 0.122574 / 2), 0.5, 1e-14);
}

TEST(Activation, IsAStepWithoutDurations) {
  const Activation held = between(1.0, 2.0, 0.0, 0.0);
  EXPECT_EQ(activation(held, std::nextafter(1.0, 0.0)), 0.0);
  EXPECT_EQ(activation(held, 1.0), 1.0);
  EXPECT_EQ(activation(held, std::nextafter(2.0, 0.0)), 1.0);
  EXPECT_EQ(activation(held, 2.0), 0.0);
}

TEST(Activation, HoldsForExactlyOneOfTwoAtAHandover) {
  const Activation before{std::nullopt, 2.0, 0.0, 0.0};
  const Activation after{2.0, std::nullopt, 0.0, 0.0};
  for (const double t : {1.0, std::nextafter(2.0, 0.0), 2.0, 3.0}) {
    EXPECT_EQ(activation(before, t) + activation(after, t), 1.0) << t;
  }
}

TEST(Activation, IsANumberWhateverTheTimes) {
  const double minimum = 5e-324;
  for (const double t : {-1e9, 0.0, minimum, 1.0, 1e9}) {
    const double active = activation(between(0.0, 1e9, minimum, 1e9), t);
    EXPECT_GE(active, 0.0);
    EXPECT_LE(active, 1.0);
  }
}

// Third derivatives of the quintic are at most 60/d^3. For the product of two with d = 1
// s, Leibniz gives 2 * 60 + 2 * 3 * 5.7735 * 1.875 < 190 /s^3. A second difference then
// changes by less than 190 h per step. A kink, or a jump of the second derivative, would
// show as a change that does not vanish with h.
TEST(Activation, KeepsItsSecondDerivativeContinuousWhileRampsOverlap) {
  const Activation brief = between(0.0, 0.4, 1.0, 1.0);
  const double h = 1e-3;
  const auto second = [&](double t) {
    return (activation(brief, t - h) - 2 * activation(brief, t) +
            activation(brief, t + h)) /
           (h * h);
  };
  double peak = 0.0;
  for (double t = -0.1; t < 1.6; t += h) {
    EXPECT_LT(std::abs(second(t + h) - second(t)), 190 * h) << t;
    peak = std::max(peak, activation(brief, t));
  }
  EXPECT_GT(peak, 0.2);  // The ramp is at 0.317 when the stop comes, and still rises.
  EXPECT_LT(peak, 1.0);
}

TEST(Activation, RisesAndThenFallsOnceWhileRampsOverlap) {
  const Activation brief = between(0.0, 0.4, 1.0, 0.7);
  int turns = 0;
  double step = 1.0;
  for (double t = 0.001; t < 1.1; t += 0.001) {
    const double next = activation(brief, t + 0.001) - activation(brief, t);
    if (step * next < 0.0) ++turns;
    if (next != 0.0) step = next;
  }
  EXPECT_EQ(turns, 1);
}

TEST(LiveActivation, IsThePlannedOneWithoutChanges) {
  for (const Activation& when : {Activation{},
                                 between(0.0, 0.4, 1.0, 1.0),
                                 between(0.5, 2.0, 0.0, 0.5),
                                 Activation{std::nullopt, 1.0, 0.0, 0.5},
                                 Activation{1.0, std::nullopt, 0.5, 0.0}}) {
    const LiveActivation live(when);
    for (double t = -0.5; t < 3.0; t += 0.01) {
      EXPECT_NEAR(live.at(t), activation(when, t), 1e-15 /* one rounding */) << t;
    }
  }
}

// As above: every change adds a factor whose derivatives, at most 1.875, 5.7735 and 60 by
// d = 1 s, multiply by Leibniz. For six changes this bounds the third derivative by 6 *
// 60 + 3 * 30 * 5.7735 * 1.875 + 120 * 1.875^3 = 2125 /s^3.
TEST(LiveActivation, GoesOnSmoothlyWheneverItIsStartedAndStopped) {
  LiveActivation live({std::nullopt, std::nullopt, 1.0, 1.0});
  for (const double t : {0.0, 0.7, 1.3}) {
    live.stop(t);
    live.start(t + 0.35);
  }
  const double h = 1e-3;
  const auto second = [&](double t) {
    return (live.at(t - h) - 2 * live.at(t) + live.at(t + h)) / (h * h);
  };
  double minimum = 1.0;
  for (double t = -0.1; t < 3.0; t += h) {
    EXPECT_LT(std::abs(second(t + h) - second(t)), 2125 * h) << t;
    minimum = std::min(minimum, live.at(t));
  }
  EXPECT_LT(minimum, 0.9);
  EXPECT_EQ(live.at(-0.1), 1.0);
  EXPECT_EQ(live.at(3.0), 1.0);
}

TEST(LiveActivation, IgnoresASecondStartAndASecondStop) {
  LiveActivation live({0.0, std::nullopt, 1.0, 1.0});
  const double risen = live.at(0.6);
  live.start(0.6);
  EXPECT_EQ(live.at(0.6), risen);
  live.stop(2.0);
  const double fallen = live.at(2.5);
  live.stop(2.5);
  EXPECT_EQ(live.at(2.5), fallen);
}

TEST(LiveActivation, AStartReplacesTheSchedule) {
  LiveActivation live(between(1.0, 2.0, 0.5, 0.5));
  live.start(0.0);
  EXPECT_EQ(live.at(0.5), 1.0);
  EXPECT_EQ(live.at(9.0), 1.0);
}

// With more changes than it stores, all within one ramp, the step from removing the
// oldest change stays below a hundredth: it is multiplied by sixteen others.
TEST(LiveActivation, SurvivesAHandThatTrembles) {
  LiveActivation live({0.0, std::nullopt, 1.0, 1.0});
  double last = live.at(2.0);
  for (int i = 0; i < 400; ++i) {
    const double t = 2.0 + 0.04 * i;
    const double before = live.at(t);
    i % 2 == 0 ? live.stop(t) : live.start(t);
    EXPECT_LT(std::abs(live.at(t) - before), 0.01) << i;
    // 1.875 per second is as fast as a ramp gets; eight of them and as many against.
    EXPECT_LT(std::abs(before - last), 8 * 1.875 * 0.04) << i;
    last = live.at(t);
    EXPECT_GE(last, 0.0);
    EXPECT_LE(last, 1.0);
  }
}

}  // namespace
}  // namespace marey::retarget
