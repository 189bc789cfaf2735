// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/flight/fit_flight.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {
namespace {

using marey::testing::Dice;

/// A parabola between two times, sampled at a rate from time 0 on.
struct ThrownPoint {
  FrameRate rate;
  FlightTimes times;
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 velocity_m_s{0.0};
  double gravity_m_s2 = 9.81;
  std::vector<glm::dvec3> frames;

  explicit ThrownPoint(Dice& dice) {
    rate.hz = dice.between(30.0, 240.0);
    times.takeoff_s = dice.between(0.2, 1.0);
    times.landing_s = times.takeoff_s + dice.between(0.2, 0.8);
    p_in_world = 2.0 * dice.direction();
    velocity_m_s = 3.0 * dice.direction();
    gravity_m_s2 = dice.between(0.5, 30.0);
    const int count = static_cast<int>((times.landing_s + 0.3) * rate.hz);
    for (int i = 0; i < count; ++i) frames.push_back(at(i / rate.hz));
  }
  [[nodiscard]] glm::dvec3 at(double time_s) const {
    const double t = time_s - times.takeoff_s;
    return p_in_world + velocity_m_s * t -
           glm::dvec3(0.0, 0.5 * gravity_m_s2 * t * t, 0.0);
  }
};

TEST(FitFlight, AParabolaIsRecoveredExactly) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Dice dice(seed);
    const ThrownPoint thrown(dice);
    const auto fit =
        fit_flight(thrown.frames, thrown.rate, thrown.times, thrown.gravity_m_s2);
    ASSERT_TRUE(fit) << seed;
    EXPECT_LT(glm::distance(fit->p_in_world, thrown.p_in_world), 1e-9) << seed;
    EXPECT_LT(glm::distance(fit->velocity_m_s, thrown.velocity_m_s), 1e-8) << seed;
    EXPECT_LT(fit->rms_m, 1e-9) << seed;
    const double middle_s = 0.5 * (thrown.times.takeoff_s + thrown.times.landing_s);
    EXPECT_LT(glm::distance(fit->position_at(middle_s), thrown.at(middle_s)), 1e-9);
    const auto fall = fit_fall_m_s2(thrown.frames, thrown.rate, thrown.times);
    if (fit->frames >= 4) {
      ASSERT_TRUE(fall) << seed;
      EXPECT_NEAR(*fall, -thrown.gravity_m_s2, 1e-6) << seed;
    } else {
      EXPECT_FALSE(fall) << seed;
    }
  }
}

// Frames outside of the flight have no influence.
TEST(FitFlight, OnlyTheFramesOfTheFlightCount) {
  Dice dice(5);
  ThrownPoint thrown(dice);
  const auto fit =
      fit_flight(thrown.frames, thrown.rate, thrown.times, thrown.gravity_m_s2);
  for (std::size_t i = 0; i < thrown.frames.size(); ++i) {
    const double time_s = static_cast<double>(i) / thrown.rate.hz;
    if (time_s < thrown.times.takeoff_s || time_s > thrown.times.landing_s) {
      thrown.frames[i] += 10.0 * dice.direction();
    }
  }
  const auto again =
      fit_flight(thrown.frames, thrown.rate, thrown.times, thrown.gravity_m_s2);
  ASSERT_TRUE(fit && again);
  EXPECT_EQ(fit->velocity_m_s, again->velocity_m_s);
}

// Standard error of a slope: sigma * sqrt(12 / n) / duration; five of them. The position
// at the end of a line has twice the standard error of the mean.
TEST(FitFlight, NoiseMovesTheStateByItsStandardErrors) {
  constexpr double kNoise_m = 0.001;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Dice dice(seed);
    ThrownPoint thrown(dice);
    for (glm::dvec3& p : thrown.frames) {
      p += glm::dvec3(dice.noise(kNoise_m), dice.noise(kNoise_m), dice.noise(kNoise_m));
    }
    const auto fit =
        fit_flight(thrown.frames, thrown.rate, thrown.times, thrown.gravity_m_s2);
    ASSERT_TRUE(fit);
    const double n = fit->frames;
    const double flight_s = thrown.times.landing_s - thrown.times.takeoff_s;
    const double slope_error = kNoise_m * std::sqrt(12.0 / n) / flight_s;
    EXPECT_LT(glm::distance(fit->velocity_m_s, thrown.velocity_m_s),
              5.0 * std::sqrt(3.0) * slope_error)
        << seed;
    EXPECT_LT(glm::distance(fit->p_in_world, thrown.p_in_world),
              5.0 * std::sqrt(3.0) * 2.0 * kNoise_m / std::sqrt(n))
        << seed;
  }
}

// One frame of thirty is off by 0.3 m. Least squares would move the middle by 10 mm.
TEST(FitFlight, OneWrongFrameIsMostlyIgnored) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(seed);
    ThrownPoint thrown(dice);
    if ((thrown.times.landing_s - thrown.times.takeoff_s) * thrown.rate.hz < 30.0)
      continue;
    const double middle_s = 0.5 * (thrown.times.takeoff_s + thrown.times.landing_s);
    const auto middle = static_cast<std::size_t>(std::lround(middle_s * thrown.rate.hz));
    thrown.frames[middle] += 0.3 * dice.direction();
    const auto fit =
        fit_flight(thrown.frames, thrown.rate, thrown.times, thrown.gravity_m_s2);
    ASSERT_TRUE(fit);
    EXPECT_LT(glm::distance(fit->position_at(middle_s), thrown.at(middle_s)), 0.001)
        << seed;
  }
}

TEST(FitFlight, AHeadingTurnsTheAnswer) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(seed);
    ThrownPoint thrown(dice);
    for (glm::dvec3& p : thrown.frames) p += 0.01 * dice.direction();
    const auto fit =
        fit_flight(thrown.frames, thrown.rate, thrown.times, thrown.gravity_m_s2);
    const glm::dquat heading =
        glm::angleAxis(dice.between(-3.0, 3.0), glm::dvec3(0.0, 1.0, 0.0));
    for (glm::dvec3& p : thrown.frames) p = heading * p;
    const auto turned =
        fit_flight(thrown.frames, thrown.rate, thrown.times, thrown.gravity_m_s2);
    ASSERT_TRUE(fit && turned);
    EXPECT_LT(glm::distance(heading * fit->velocity_m_s, turned->velocity_m_s), 1e-7);
    EXPECT_NEAR(fit->rms_m, turned->rms_m, 1e-9);
  }
}

TEST(FitFlight, TooFewFramesHaveNoFit) {
  const std::vector<glm::dvec3> frames(20, glm::dvec3(0.0));
  EXPECT_FALSE(fit_flight(frames, {100.0}, {0.051, 0.059}, 9.81));
  EXPECT_FALSE(fit_flight(frames, {100.0}, {0.051, 0.069}, 9.81));
  EXPECT_TRUE(fit_flight(frames, {100.0}, {0.051, 0.079}, 9.81));
  EXPECT_FALSE(fit_fall_m_s2(frames, {100.0}, {0.051, 0.089}));
  EXPECT_FALSE(fit_flight(frames, {100.0}, {5.0, 6.0}, 9.81));
  EXPECT_FALSE(fit_flight({}, {100.0}, {0.0, 1.0}, 9.81));
}

}  // namespace
}  // namespace marey::dynamics
