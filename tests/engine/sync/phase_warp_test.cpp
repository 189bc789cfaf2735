// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/phase_warp.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::engine {
namespace {

double drawn(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Knots from `time_s` on, with mean rates between these.
std::vector<WarpKnot> random_knots(std::mt19937_64& random,
                                   double time_s,
                                   double source_s,
                                   double low,
                                   double high,
                                   double min_step_s = 0.06) {
  std::vector<WarpKnot> knots;
  const int count = static_cast<int>(random() % 7);
  for (int i = 0; i < count; ++i) {
    const double step_s = drawn(random, min_step_s, 0.5);
    time_s += step_s;
    source_s += step_s * drawn(random, low, high);
    knots.push_back({time_s, source_s});
  }
  return knots;
}

double worst_jump(const PhaseWarp& warp) {
  double worst = 0.0;
  const auto check = [&](double time_s) {
    const double before_s = std::nextafter(time_s, -1e9);
    worst = std::max(worst, std::abs(warp.source_s(time_s) - warp.source_s(before_s)));
    worst = std::max(worst, std::abs(warp.rate(time_s) - warp.rate(before_s)));
    // The acceleration itself changes by the jerk times a rounding of time.
    const double scale = std::max(1.0, std::abs(warp.acceleration(time_s)));
    worst = std::max(
        worst, std::abs(warp.acceleration(time_s) - warp.acceleration(before_s)) / scale);
  };
  for (std::size_t i = 1; i < warp.piece_count(); ++i) check(warp.piece_start_s(i));
  check(warp.end_s());
  return worst;
}

TEST(PhaseWarp, IsSmoothAndNeverStandsStillOverRandomReplans) {
  std::mt19937_64 random(1);
  double worst = 0.0;
  double min_rate = 9.0;
  double max_rate = 0.0;
  int within_plan = 0;
  for (int set = 0; set < 25000; ++set) {
    PhaseWarp warp;
    double now_s = drawn(random, 0.0, 10.0);
    warp.start(now_s, drawn(random, 0.0, 3.0), drawn(random, 0.25, 4.0));
    for (int replan = 0; replan < 4; ++replan) {
      const double keep_s = replan == 3 ? 0.0 : 0.1;
      const double value = warp.source_s(now_s + keep_s);
      const double rate = warp.rate(now_s + keep_s);
      const double acceleration = warp.acceleration(now_s + keep_s);
      const double kept = warp.source_s(now_s + 0.5 * keep_s);
      const auto knots = random_knots(
          random, now_s + keep_s, value + drawn(random, -0.05, 0.05), 0.2, 4.2);
      warp.replan(now_s, knots, drawn(random, 0.25, 4.0), keep_s);
      EXPECT_NEAR(warp.source_s(now_s + 0.5 * keep_s), kept, 1e-12);
      EXPECT_NEAR(warp.source_s(now_s + keep_s), value, 1e-12);
      EXPECT_NEAR(warp.rate(now_s + keep_s), rate, 1e-9);
      EXPECT_NEAR(warp.acceleration(now_s + keep_s),
                  acceleration,
                  1e-9 * std::max(1.0, std::abs(acceleration)));
      worst = std::max(worst, worst_jump(warp));
      for (double t = now_s; t < warp.end_s() + 0.1; t += 0.011) {
        min_rate = std::min(min_rate, warp.rate(t));
        max_rate = std::max(max_rate, warp.rate(t));
      }
      now_s += drawn(random, 0.0, 0.6);
      within_plan += now_s + 0.1 < warp.end_s() ? 1 : 0;
    }
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GE(min_rate, kMinWarpRate - 1e-12);
  EXPECT_LE(max_rate, kMaxWarpRate + 1e-12);
  EXPECT_GT(within_plan, 10000);
}

TEST(PhaseWarp, MeetsKnotsOfModerateRatesExactly) {
  std::mt19937_64 random(2);
  for (int set = 0; set < 5000; ++set) {
    PhaseWarp warp;
    warp.start(5.0, 1.0, drawn(random, 0.5, 2.0));
    auto knots = random_knots(random, 5.1, warp.source_s(5.1), 0.5, 2.0, 0.12);
    EXPECT_TRUE(warp.replan(5.0, knots, drawn(random, 0.5, 2.0)));
    for (const WarpKnot& knot : knots) {
      EXPECT_NEAR(warp.source_s(knot.time_s), knot.source_s, 1e-12);
    }
  }
}

TEST(PhaseWarp, ContinuesAtTheEndRate) {
  PhaseWarp warp;
  warp.start(0.0, 0.0, 1.0);
  const std::vector<WarpKnot> knots{{0.4, 0.5}, {0.8, 0.8}};
  EXPECT_TRUE(warp.replan(0.0, knots, 1.3));
  EXPECT_DOUBLE_EQ(warp.end_s(), 0.8);
  EXPECT_NEAR(warp.source_s(1.8), 2.1, 1e-12);
  EXPECT_DOUBLE_EQ(warp.rate(0.9), 1.3);
  EXPECT_EQ(warp.acceleration(0.8), 0.0);
}

TEST(PhaseWarp, ReportsKnotsThatNoRatePermits) {
  PhaseWarp warp;
  warp.start(0.0, 0.0, 1.0);
  const std::vector<WarpKnot> knots{{0.3, 2.0}};
  EXPECT_FALSE(warp.replan(0.0, knots, 1.0));
  EXPECT_GT(warp.source_s(0.3), 0.75);
  EXPECT_LT(warp.source_s(0.3), 0.1 + 0.8);
}

TEST(PhaseWarp, KeepsALine) {
  PhaseWarp warp;
  warp.start(0.0, 2.0, 0.25);
  const std::vector<WarpKnot> knots{{0.5, 2.125}, {1.0, 2.25}};
  EXPECT_TRUE(warp.replan(0.0, knots, 0.25));
  for (double t = 0.0; t < 2.0; t += 0.1) {
    EXPECT_NEAR(warp.source_s(t), 2.0 + 0.25 * t, 1e-14);
    EXPECT_NEAR(warp.rate(t), 0.25, 1e-14);
  }
}

}  // namespace
}  // namespace marey::engine
