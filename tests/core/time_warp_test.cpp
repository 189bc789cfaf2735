// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/time_warp.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey {
namespace {

std::vector<WarpKnot> random_knots(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(0.05, 1.0);
  std::vector<WarpKnot> out{{0.0, 0.0}};
  for (int i = 1; i < count; ++i) {
    out.push_back({out.back().time_s + step(random), out.back().source_s + step(random)});
  }
  return out;
}

TEST(TimeWarp, MeetsRandomKnotsAndAscendsBetweenThem) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const auto knots = random_knots(seed, 8);
    const TimeWarp warp(knots);
    for (const WarpKnot& knot : knots) {
      EXPECT_NEAR(warp.source_s(knot.time_s), knot.source_s, 1e-12);
    }
    double last = warp.source_s(0.0);
    for (double t = 1e-3; t < knots.back().time_s; t += 1e-3) {
      const double now = warp.source_s(t);
      EXPECT_GT(now, last) << "seed " << seed << " at " << t;
      EXPECT_GT(warp.speed(t), 0.0);
      last = now;
    }
  }
}

TEST(TimeWarp, HasContinuousSpeedAndAccelerationAtKnots) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const auto knots = random_knots(seed, 6);
    const TimeWarp warp(knots);
    for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
      const double t = knots[i].time_s;
      constexpr double kStep = 1e-7;
      EXPECT_NEAR(warp.speed(t - kStep), warp.speed(t + kStep), 1e-2);
      const double before = (warp.speed(t) - warp.speed(t - kStep)) / kStep;
      const double after = (warp.speed(t + kStep) - warp.speed(t)) / kStep;
      EXPECT_NEAR(before, after, 0.05) << "seed " << seed;
    }
  }
}

TEST(TimeWarp, IsALineToTheBitForKnotsOnALine) {
  const std::vector<WarpKnot> knots{{0.0, 0.0}, {1.0, 0.5}, {3.0, 1.5}, {4.0, 2.0}};
  const TimeWarp warp(knots);
  for (double t = -1.0; t < 6.0; t += 0.125) EXPECT_EQ(warp.source_s(t), 0.5 * t);
}

TEST(TimeWarp, ShiftsTimeForOneKnot) {
  const std::vector<WarpKnot> knots{{2.0, 5.0}};
  const TimeWarp warp(knots);
  EXPECT_DOUBLE_EQ(warp.source_s(0.0), 3.0);
  EXPECT_DOUBLE_EQ(warp.source_s(7.0), 10.0);
}

}  // namespace
}  // namespace marey
