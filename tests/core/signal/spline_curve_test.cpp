// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/spline_curve.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_channel.h"

namespace marey {
namespace {

constexpr std::size_t kCurveSamples = 241;
constexpr double kCurveRate_hz = 120.0;

class SplineCurveOfOrder : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, SplineCurveOfOrder, ::testing::Values(2, 3));

TEST_P(SplineCurveOfOrder, PassesThroughTheFittedValues) {
  const auto channel = testing::with_noise(
      testing::band_limited(kCurveSamples, kCurveRate_hz, 8.0, 1), 0.01, 1);
  SmoothingSpline spline(kCurveSamples, {GetParam()});
  spline.set_penalty(50.0);
  const SplineCurve curve(spline, channel, kCurveRate_hz);
  std::vector<double> fitted(kCurveSamples);
  static_cast<void>(spline.fit(channel, fitted));
  for (std::size_t i = 0; i < kCurveSamples; ++i) {
    EXPECT_NEAR(curve.at(static_cast<double>(i) / kCurveRate_hz), fitted[i], 1e-12);
  }
}

// The conditions that define the minimiser (Reinsch 1967): at each sample, penalty times
// the jump of the derivative 2m - 1 is the residual, and the derivatives m to 2m - 2
// vanish at both ends. The derivative jumps from 0 to its value at the first sample.
TEST_P(SplineCurveOfOrder, MeetsTheConditionsOfTheMinimiser) {
  const int m = GetParam();
  const double penalty = 20.0;
  const auto channel =
      testing::with_noise(testing::band_limited(kCurveSamples, 1.0, 0.1, 1), 0.01, 1);
  SmoothingSpline spline(kCurveSamples, {m});
  spline.set_penalty(penalty);
  const SplineCurve curve(spline, channel, 1.0);
  const double sign = m == 2 ? 1.0 : -1.0;
  for (std::size_t i = 0; i < kCurveSamples; ++i) {
    const double t = static_cast<double>(i);
    const double before = i == 0 ? 0.0 : curve.at(t - 0.5, 2 * m - 1);
    const double after = i + 1 == kCurveSamples ? 0.0 : curve.at(t + 0.5, 2 * m - 1);
    EXPECT_NEAR(sign * penalty * (after - before), channel[i] - curve.at(t), 1e-9) << i;
  }
  for (int derivative = m; derivative <= 2 * m - 2; ++derivative) {
    EXPECT_NEAR(curve.at(0.0, derivative), 0.0, 1e-12);
    EXPECT_NEAR(curve.at(curve.end_s(), derivative), 0.0, 1e-12);
  }
}

TEST_P(SplineCurveOfOrder, DerivativesAreThoseOfItsValues) {
  const auto channel = testing::band_limited(kCurveSamples, kCurveRate_hz, 6.0, 2);
  SmoothingSpline spline(kCurveSamples, {GetParam()});
  spline.set_penalty(1.0);
  const SplineCurve curve(spline, channel, kCurveRate_hz);
  constexpr double kStep_s = 1e-5;
  for (int derivative = 0; derivative < 3; ++derivative) {
    for (double t = 0.01; t < 1.99; t += 0.0371) {
      const double slope =
          (curve.at(t + kStep_s, derivative) - curve.at(t - kStep_s, derivative)) /
          (2.0 * kStep_s);
      const double expected = curve.at(t, derivative + 1);
      EXPECT_NEAR(slope, expected, 1e-4 * (1.0 + std::pow(40.0, derivative + 1)));
    }
  }
}

TEST_P(SplineCurveOfOrder, AnUnsmoothedSineIsRightBetweenTheSamplesAndInItsDerivatives) {
  const double w = 2.0 * std::numbers::pi * 2.0;
  std::vector<double> channel(kCurveSamples);
  for (std::size_t i = 0; i < kCurveSamples; ++i) {
    channel[i] = std::sin(w * static_cast<double>(i) / kCurveRate_hz);
  }
  SmoothingSpline spline(kCurveSamples, {GetParam()});
  spline.set_penalty(1e-9);
  const SplineCurve curve(spline, channel, kCurveRate_hz);
  for (double t = 0.5; t < 1.5; t += 0.0123) {  // Away from the natural ends.
    EXPECT_NEAR(curve.at(t), std::sin(w * t), 1e-6);
    EXPECT_NEAR(curve.at(t, 1), w * std::cos(w * t), 1e-3 * w);
    EXPECT_NEAR(curve.at(t, 2), -w * w * std::sin(w * t), 2e-3 * w * w);
  }
}

TEST_P(SplineCurveOfOrder, SlowedDownItHasNoFrequencyAboveTheSourcesNyquist) {
  // Four times slower: the energy above the source's Nyquist frequency of the second
  // derivative, by a Hann-windowed Fourier sum at 5 frequencies above it.
  const auto channel = testing::with_noise(
      testing::band_limited(kCurveSamples, kCurveRate_hz, 8.0, 3), 0.003, 3);
  SmoothingSpline spline(kCurveSamples, {GetParam()});
  spline.set_penalty(penalty_of_half_power(12.0, kCurveRate_hz, {GetParam()}));
  const SplineCurve curve(spline, channel, kCurveRate_hz);
  const auto amplitude = [&](double frequency_hz) {
    double re = 0.0;
    double im = 0.0;
    constexpr int kSlowed = 4 * (static_cast<int>(kCurveSamples) - 1);
    for (int i = 0; i <= kSlowed; ++i) {
      const double t = i / (4.0 * kCurveRate_hz);
      const double window = 1.0 - std::cos(2.0 * std::numbers::pi * i / kSlowed);
      const double phase = 2.0 * std::numbers::pi * frequency_hz * t;
      re += window * curve.at(t) * std::cos(phase) / kSlowed;
      im += window * curve.at(t) * std::sin(phase) / kSlowed;
    }
    return 2.0 * std::hypot(re, im);
  };
  for (const double frequency_hz : {65.0, 90.0, 120.0, 150.0, 200.0}) {
    EXPECT_LT(amplitude(frequency_hz), 1e-5 /* m, of a motion of 0.2 m */);
  }
}

}  // namespace
}  // namespace marey
