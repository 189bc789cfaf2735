// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/transition/inertial_offset.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/engine/blend/blend_truth.h"

namespace marey::engine {
namespace {

constexpr double kLn2 = std::numbers::ln2;

PostureRates random_rates(std::mt19937& random, double greatest_rad_s) {
  PostureRates rates;
  const auto some = [&](double limit) {
    return static_cast<float>(random_in(random, -limit, limit));
  };
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    rates.x[i] = some(greatest_rad_s);
    rates.y[i] = some(greatest_rad_s);
    rates.z[i] = some(greatest_rad_s);
  }
  for (float& rate : rates.mid_x) rate = some(0.5);
  for (float& rate : rates.upper_twist) rate = some(3.0);
  rates.height = some(1.0);
  return rates;
}

double greatest_angle_rad(const BlendPosture& a, const BlendPosture& b) {
  double greatest_rad = 0.0;
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    greatest_rad =
        std::max(greatest_rad, angle_between_rad(rotation_in(a, i), rotation_in(b, i)));
  }
  return greatest_rad;
}

double greatest_rate_error(const PostureRates& a, const PostureRates& b) {
  double greatest = std::abs(static_cast<double>(a.height - b.height));
  for (std::size_t i = 0; i < kUsedRotations; ++i) {
    greatest = std::max({greatest,
                         std::abs(static_cast<double>(a.x[i] - b.x[i])),
                         std::abs(static_cast<double>(a.y[i] - b.y[i])),
                         std::abs(static_cast<double>(a.z[i] - b.z[i]))});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    greatest = std::max(
        greatest, std::abs(static_cast<double>(a.upper_twist[i] - b.upper_twist[i])));
  }
  return greatest;
}

// Value and velocity at the switch by finite differences, for offsets up to 170 degrees.
TEST(InertialOffset, IsContinuousInValueAndVelocity) {
  constexpr float kStep_s = 5e-4F;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const auto p = random_postures(random, 2, 170.0 * std::numbers::pi / 180.0);
    const PostureRates from_rates = random_rates(random, 2.0);
    const PostureRates to_rates = random_rates(random, 2.0);
    InertialOffset offset;
    offset.start(p[0], from_rates, p[1], to_rates);
    BlendPosture now = p[1];
    offset.step(0.0F, 0.1F, now);
    EXPECT_LT(greatest_angle_rad(now, p[0]), 3e-6);
    EXPECT_NEAR(now.height_legs, p[0].height_legs, 1e-6);
    BlendPosture next = p[1];
    move_posture(to_rates, kStep_s, next);
    offset.step(kStep_s, 0.1F, next);
    // Accelerations of up to some 600 rad/s^2 within the step, and single precision.
    EXPECT_LT(greatest_rate_error(rates_between(now, next, kStep_s), from_rates), 0.3);
  }
}

TEST(InertialOffset, DecaysByTheClosedForm) {
  std::mt19937 random(5);
  const auto p = random_postures(random, 2, 1.0);
  PostureRates from_rates;
  from_rates.height = 0.7F;
  InertialOffset offset;
  offset.start(p[0], from_rates, p[1], {});
  const double y = 2.0 * kLn2 / 0.1;
  const double x = static_cast<double>(p[0].height_legs - p[1].height_legs);
  const glm::dvec3 turn =
      log_of(rotation_in(p[0], 8) * glm::conjugate(rotation_in(p[1], 8)));
  for (int step = 1; step <= 40; ++step) {
    BlendPosture shown = p[1];
    offset.step(1.0F / 60.0F, 0.1F, shown);
    const double t = step / 60.0;
    const double left = (x + (0.7 + x * y) * t) * std::exp(-y * t);
    EXPECT_NEAR(static_cast<double>(shown.height_legs - p[1].height_legs), left, 1e-6);
    const glm::dquat truth =
        exp_of((1.0 + y * t) * std::exp(-y * t) * turn) * rotation_in(p[1], 8);
    EXPECT_LT(angle_between_rad(rotation_in(shown, 8), truth), 3e-6);
  }
}

TEST(InertialOffset, EndsWhenItIsNegligible) {
  std::mt19937 random(6);
  const auto p = random_postures(random, 2, 1.0);
  InertialOffset offset;
  EXPECT_FALSE(offset.is_active());
  offset.start(p[0], {}, p[1], {});
  EXPECT_TRUE(offset.is_active());
  BlendPosture shown;
  int steps = 0;
  for (; offset.is_active() && steps < 1000; ++steps) {
    shown = p[1];
    offset.step(1.0F / 60.0F, 0.1F, shown);
  }
  EXPECT_LT(steps, 200);
  EXPECT_EQ(shown, p[1]);
}

// The second switch takes the shown posture, so that the rest of the first offset is part
// of the second one.
TEST(InertialOffset, AddsUpOverNestedSwitches) {
  std::mt19937 random(9);
  const auto p = random_postures(random, 3, 1.0);
  InertialOffset offset;
  offset.start(p[0], {}, p[1], {});
  BlendPosture before = p[1];
  offset.step(1.0F / 60.0F, 0.1F, before);
  BlendPosture shown = p[1];
  offset.step(1.0F / 60.0F, 0.1F, shown);
  const double first = static_cast<double>(shown.height_legs - p[1].height_legs);
  offset.start(shown, rates_between(before, shown, 1.0F / 60.0F), p[2], {});
  BlendPosture after = p[2];
  offset.step(0.0F, 0.1F, after);
  EXPECT_LT(greatest_angle_rad(after, shown), 3e-6);
  EXPECT_NEAR(static_cast<double>(after.height_legs - p[2].height_legs),
              first + static_cast<double>(p[1].height_legs - p[2].height_legs),
              1e-6);
}

TEST(RatesBetween, AreThoseOfTheMove) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const BlendPosture before = random_postures(random, 1, 1.0)[0];
    const PostureRates rates = random_rates(random, 10.0);
    BlendPosture now = before;
    move_posture(rates, 1.0F / 60.0F, now);
    EXPECT_LT(greatest_rate_error(rates_between(before, now, 1.0F / 60.0F), rates), 2e-4);
  }
}

TEST(Extrapolate, DecaysToTheIntegralOfItsVelocity) {
  std::mt19937 random(11);
  const BlendPosture start = random_postures(random, 1, 1.0)[0];
  PostureRates rates;
  rates.height = 0.4F;
  rates.z[2] = 3.0F;
  BlendPosture posture = start;
  for (int step = 0; step < 600; ++step) extrapolate(1.0F / 60.0F, 0.15F, rates, posture);
  const double time_s = 0.15 / kLn2;
  EXPECT_NEAR(
      static_cast<double>(posture.height_legs - start.height_legs), 0.4 * time_s, 1e-5);
  EXPECT_LT(angle_between_rad(rotation_in(posture, 2),
                              exp_of({0.0, 0.0, 3.0 * time_s}) * rotation_in(start, 2)),
            2e-5);
  EXPECT_LT(std::abs(rates.height), 1e-10F);
}

}  // namespace
}  // namespace marey::engine
