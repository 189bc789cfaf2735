// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/activation.h"

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

TEST(Activation, OfTwoThatHandOverExactlyOneHolds) {
  const Activation before{std::nullopt, 2.0, 0.0, 0.0};
  const Activation after{2.0, std::nullopt, 0.0, 0.0};
  for (const double t : {1.0, std::nextafter(2.0, 0.0), 2.0, 3.0}) {
    EXPECT_EQ(activation(before, t) + activation(after, t), 1.0) << t;
  }
}

TEST(Activation, IsANumberWhateverTheTimes) {
  const double least = 5e-324;
  for (const double t : {-1e9, 0.0, least, 1.0, 1e9}) {
    const double active = activation(between(0.0, 1e9, least, 1e9), t);
    EXPECT_GE(active, 0.0);
    EXPECT_LE(active, 1.0);
  }
}

// Third derivatives of the quintic are at most 60/d^3; of the product of two with
// d = 1 s, by Leibniz: 2 * 60 + 2 * 3 * 5.7735 * 1.875 < 190 /s^3. Then a second
// difference changes by less than 190 h per step; a kink, or a jump of the second
// derivative, would show as a change that does not vanish with h.
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

}  // namespace
}  // namespace marey::retarget
