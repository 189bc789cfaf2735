// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/fit_push.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::dynamics {
namespace {

constexpr double kDuration_s = 0.7;
constexpr double kStart_m_s = -2.4;

/// Force of a drop jump: 0 in flight at both ends, an impact and a push. [m/s^2]
double true_force(double t_s) {
  const double x = t_s / kDuration_s;
  const double pulse = std::sin(std::numbers::pi * x);
  return pulse * (38.0 + 14.0 * std::cos(3.0 * std::numbers::pi * x));
}

struct Track {
  std::vector<double> time_s, height_m;
  double end_m_s = 0.0;
};
/// Integrates the force with 1000 steps per frame.
Track drop_jump(double rate_hz, double noise_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  Track out;
  double height_m = 1.0;
  double speed_m_s = kStart_m_s;
  constexpr int kSteps = 1000;
  const double step_s = 1.0 / (rate_hz * kSteps);
  const int frames = static_cast<int>(std::floor(kDuration_s * rate_hz + 1e-9)) + 1;
  for (int i = 0; i < frames; ++i) {
    out.time_s.push_back(std::min(i / rate_hz, kDuration_s));
    out.height_m.push_back(height_m + noise_m * noise(random));
    for (int k = 0; k < kSteps && i + 1 < frames; ++k) {
      const double middle_s = i / rate_hz + (k + 0.5) * step_s;
      const double acceleration = true_force(middle_s) - kStandardGravity_m_s2;
      height_m += step_s * (speed_m_s + 0.5 * step_s * acceleration);
      speed_m_s += step_s * acceleration;
    }
  }
  out.end_m_s = speed_m_s;
  return out;
}

double force_rms(const PushFit& fit) {
  double squares = 0.0;
  for (int i = 0; i <= 200; ++i) {
    const double x = i / 200.0;
    const double off = reference_force(fit.reference, x) - true_force(x * kDuration_s);
    squares += off * off / 201.0;
  }
  return std::sqrt(squares);
}

TEST(FitPush, RecoversTheForceAndTheStatesOfExactHeights) {
  const Track track = drop_jump(100.0, 0.0, 0);
  const auto fit = fit_push(track.time_s,
                            track.height_m,
                            kDuration_s,
                            {.from_flight = true, .to_flight = true, .cutoff_hz = 12.0});
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->rms_m, 1e-4);
  EXPECT_NEAR(fit->ends.start_m_s, kStart_m_s, 0.01);
  EXPECT_NEAR(fit->ends.end_m_s, track.end_m_s, 0.01);
  EXPECT_LT(force_rms(*fit), 0.6);
  EXPECT_EQ(fit->reference.force_m_s2.front(), 0.0);
  EXPECT_EQ(fit->reference.force_m_s2.back(), 0.0);
}

TEST(FitPush, RecoversTheForceUnderAMillimetreOfNoise) {
  int good = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Track track = drop_jump(100.0, 1e-3, seed);
    const auto fit = fit_push(track.time_s,
                              track.height_m,
                              kDuration_s,
                              {.from_flight = true, .to_flight = true});
    ASSERT_TRUE(fit);
    EXPECT_LT(fit->rms_m, 2e-3) << seed;
    EXPECT_LT(force_rms(*fit), 8.0) << seed;  // The mean is 24 m/s^2.
    if (std::abs(fit->ends.start_m_s - kStart_m_s) < 0.1) ++good;
  }
  EXPECT_GT(good, 190);
}

TEST(FitPush, TheReferenceHasTheMomentsOfTheEnds) {
  const Track track = drop_jump(120.0, 0.0, 0);
  const auto fit = fit_push(track.time_s, track.height_m, kDuration_s, {});
  ASSERT_TRUE(fit);
  const double t = kDuration_s;
  const double impulse_m_s =
      fit->ends.end_m_s - fit->ends.start_m_s + kStandardGravity_m_s2 * t;
  EXPECT_NEAR(fit->reference.impulse_m_s.back(), impulse_m_s, 0.02);
  const double gain_m = fit->ends.end_m - fit->ends.start_m - fit->ends.start_m_s * t +
                        0.5 * kStandardGravity_m_s2 * t * t;
  EXPECT_NEAR(fit->reference.double_impulse_m.back(), gain_m, 0.01);
}

TEST(FitPush, AHorizontalForceKeepsItsSign) {
  std::vector<double> time_s, position_m;
  for (int i = 0; i <= 40; ++i) {
    const double t_s = i / 100.0;
    time_s.push_back(t_s);
    position_m.push_back(3.0 * t_s - 1.5 * t_s * t_s);
  }
  const auto fit = fit_push(time_s, position_m, 0.4, {.is_horizontal = true});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->ends.start_m_s, 3.0, 1e-6);
  EXPECT_NEAR(fit->ends.end_m_s, 1.8, 1e-6);
  EXPECT_NEAR(reference_force(fit->reference, 0.5), -3.0, 1e-4);
}

TEST(FitPush, DeclinesTooFewOrInfinitePositions) {
  Track track = drop_jump(100.0, 0.0, 0);
  EXPECT_FALSE(fit_push(
      std::span(track.time_s).first(7), std::span(track.height_m).first(7), kDuration_s));
  track.height_m[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fit_push(track.time_s, track.height_m, kDuration_s));
}

}  // namespace
}  // namespace marey::dynamics
