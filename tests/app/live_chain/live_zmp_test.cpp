// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_zmp.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace marey::app {
namespace {

constexpr double kG_m_s2 = 9.81;

// The point of a body with a constant acceleration is known exactly, at any frame times.
TEST(LiveZmp, IsExactForAConstantAcceleration) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 dice(seed);
    std::uniform_real_distribution<double> one(-1.0, 1.0);
    const glm::dvec3 start(one(dice), 1.0 + 0.3 * one(dice), one(dice));
    const glm::dvec3 speed(one(dice), 0.5 * one(dice), one(dice));
    const glm::dvec3 pull(3.0 * one(dice), 4.0 * one(dice), 3.0 * one(dice));
    const double floor_m = 0.2 * one(dice);
    LiveZmp zmp;
    glm::dvec3 com(0.0);
    double time_s = 0.0;
    for (int i = 0; i < 40; ++i) {
      const double step_s = 0.02 + 0.01 * one(dice);
      time_s += step_s;
      com = start + speed * time_s + 0.5 * pull * time_s * time_s;
      zmp.step(com, step_s);
    }
    const auto p = zmp.on_floor(floor_m);
    ASSERT_TRUE(p) << seed;
    const double lever_s2 = (com.y - floor_m) / (pull.y + kG_m_s2);
    EXPECT_NEAR(p->x, com.x - lever_s2 * pull.x, 1e-9) << seed;
    EXPECT_NEAR(p->y, com.z - lever_s2 * pull.z, 1e-9) << seed;
  }
}

TEST(LiveZmp, IsAbsentInFlightAndRightAfterAReset) {
  LiveZmp zmp;
  const double step_s = 1.0 / 60.0;
  for (int i = 0; i < 30; ++i) {
    const double t = i * step_s;
    zmp.step({t, 2.0 - 0.5 * kG_m_s2 * t * t, 0.0}, step_s);
    EXPECT_FALSE(zmp.on_floor(0.0)) << i;
  }
  for (int i = 0; i < 30; ++i) zmp.step({0.0, 1.0, 0.0}, step_s);
  EXPECT_TRUE(zmp.on_floor(0.0));
  zmp.reset();
  EXPECT_FALSE(zmp.on_floor(0.0));
  for (int i = 1; i <= 30; ++i) {
    zmp.step({0.0, 1.0, 0.0}, step_s);
    // Position 7 is half a window after the first one, within rounding.
    if (i == 7) continue;
    EXPECT_EQ(zmp.on_floor(0.0).has_value(), i > 7) << i;
  }
  // A long gap leaves too few positions.
  zmp.step({0.0, 1.0, 0.0}, 0.5);
  EXPECT_FALSE(zmp.on_floor(0.0));
  // Slow frames leave two positions within the window.
  for (int i = 0; i < 10; ++i) zmp.step({0.0, 1.0, 0.0}, 0.15);
  EXPECT_FALSE(zmp.on_floor(0.0));
}

TEST(LiveZmp, StaysNearAStandingBodyWhosePositionsHaveNoise) {
  double squares_m2 = 0.0;
  int count = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 dice(seed);
    std::normal_distribution<double> noise_m(0.0, 0.001);
    LiveZmp zmp;
    for (int i = 0; i < 30; ++i) {
      zmp.step({noise_m(dice), 1.0 + noise_m(dice), noise_m(dice)}, 1.0 / 60.0);
    }
    const auto p = zmp.on_floor(0.0);
    ASSERT_TRUE(p);
    squares_m2 += p->x * p->x + p->y * p->y;
    count += 2;
  }
  const double rms_m = std::sqrt(squares_m2 / count);
  EXPECT_LT(rms_m, 0.025);
  EXPECT_GT(rms_m, 0.010) << "the figure in the header is too pessimistic";
}

// At high rates the window is shorter, but never too short for a value.
TEST(LiveZmp, HasAValueAtHighRates) {
  for (const double rate_hz : {60.0, 120.0, 240.0, 500.0}) {
    LiveZmp zmp;
    for (int i = 0; i < 1000; ++i) zmp.step({0.0, 1.0, 0.0}, 1.0 / rate_hz);
    EXPECT_TRUE(zmp.on_floor(0.0)) << rate_hz;
  }
}

}  // namespace
}  // namespace marey::app
