// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/contacts/descent_arrest.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/quantile.h"
#include "retarget/contacts/contact_edges.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

constexpr double kLength_s = 0.5;

// Heights of a point that moves down at 0.4 m/s and accelerates by -15 m/s^2 before an
// instant and by `after_m_per_s2` from then on.
std::vector<double> heights(double hz, double step_s, double after_m_per_s2) {
  std::vector<double> out;
  for (int k = 0; k < static_cast<int>(kLength_s * hz); ++k) {
    const double s = k / hz - step_s;
    const double acceleration = s < 0.0 ? -15.0 : after_m_per_s2;
    out.push_back(0.1 - 0.4 * s + 0.5 * acceleration * s * s);
  }
  return out;
}

TEST(DescentArrest, IsRecoveredBetweenFramesAtAnyRate) {
  for (const double hz : {50.0, 60.0, 100.0, 250.0, 1000.0}) {
    for (const double step_s : {0.241, 0.2487, 0.253}) {
      const auto found = find_descent_arrest(heights(hz, step_s, 20.0), hz, 0.25 * hz);
      ASSERT_TRUE(found) << hz;
      EXPECT_NEAR(found->frame / hz, step_s, 1e-4) << hz;
      EXPECT_NEAR(found->change_m_per_s2, 35.0, 1.0) << hz;
    }
  }
}

TEST(DescentArrest, IsRecoveredUnderNoiseOf1mm) {
  std::vector<double> off_ms;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    testing::Dice dice(seed);
    const double step_s = dice.between(0.24, 0.26);
    std::vector<double> noisy = heights(120.0, step_s, 20.0);
    for (double& height : noisy) height += dice.noise(0.001);
    const auto found = find_descent_arrest(noisy, 120.0, 0.25 * 120.0);
    if (found) off_ms.push_back(1e3 * std::abs(found->frame / 120.0 - step_s));
  }
  ASSERT_GE(off_ms.size(), 38U);
  EXPECT_LT(median(off_ms), 3.0);
  EXPECT_LT(quantile(off_ms, 0.9), 8.0);
}

TEST(DescentArrest, DoesNotDependOnHeightAndVelocity) {
  std::vector<double> moved = heights(100.0, 0.247, 20.0);
  const auto truth = find_descent_arrest(moved, 100.0, 25.0);
  ASSERT_TRUE(truth);
  for (std::size_t k = 0; k < moved.size(); ++k) {
    moved[k] += 3.0 - 1.2 * static_cast<double>(k) / 100.0;
  }
  const auto found = find_descent_arrest(moved, 100.0, 25.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->frame, truth->frame, 1e-6);
}

TEST(DescentArrest, IsAbsentWithoutAnUpwardStepNearby) {
  // Downward, and upward too far away.
  EXPECT_FALSE(find_descent_arrest(heights(100.0, 0.25, -60.0), 100.0, 25.0));
  EXPECT_FALSE(find_descent_arrest(heights(100.0, 0.4, 20.0), 100.0, 25.0));
}

TEST(DescentArrest, IsAbsentInNoise) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    testing::Dice dice(seed);
    std::vector<double> noise(60);
    for (double& height : noise) height = dice.noise(0.003);
    if (find_descent_arrest(noise, 120.0, 30.0)) ++found;
  }
  EXPECT_LE(found, 2);
}

TEST(DescentArrest, IsAbsentNearTheEndsAndInFewFrames) {
  const std::vector<double> some = heights(60.0, 0.25, 20.0);
  EXPECT_FALSE(find_descent_arrest(some, 60.0, -10.0));
  EXPECT_FALSE(find_descent_arrest(some, 60.0, 200.0));
  for (std::size_t count = 0; count < 6; ++count) {
    EXPECT_FALSE(find_descent_arrest(std::vector<double>(count), 60.0, 2.0)) << count;
  }
}

// Errors of the strikes of a walk whose feet fall onto the floor. The truth is the start
// of the arrest, less the delay that the rule assumes. [ms]
std::vector<double> falling_walk_errors(double hz, double noise_m) {
  constexpr double kFall_m_per_s2 = 20.0;
  constexpr double kHalfCycle_s = 0.55;
  const Motion walk = testing::synthetic_walk(
                          static_cast<int>(3.3 * hz), hz, 0.0, noise_m, kFall_m_per_s2)
                          .motion;
  const ContactEdges edges = find_contact_edges(walk, mapped(walk.skeleton));
  std::vector<double> off_ms;
  for (const auto& foot : edges.feet) {
    for (const StanceEdges& stance : foot) {
      if (!stance.strike) continue;
      EXPECT_EQ(stance.strike->rule, EdgeRule::kArrest) << hz << " Hz";
      const double arrested_s =
          stance.strike->time_s + ContactEdgeOptions{}.arrest_delay_s;
      off_ms.push_back(1e3 * std::abs(std::remainder(arrested_s, kHalfCycle_s)));
    }
  }
  EXPECT_GE(off_ms.size(), 4U);
  return off_ms;
}

TEST(DescentArrest, TimesTheStrikesOfAFallingFoot) {
  for (const double hz : {50.0, 60.0, 120.0, 250.0}) {
    EXPECT_LT(quantile(falling_walk_errors(hz, 0.0), 1.0), 5.0) << hz << " Hz";
  }
}

TEST(DescentArrest, TimesTheStrikesOfAFallingFootUnderNoiseOf1mm) {
  EXPECT_LT(quantile(falling_walk_errors(120.0, 0.001), 0.9), 8.0);
}

}  // namespace
}  // namespace marey::retarget
