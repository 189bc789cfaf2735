// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/smoothing_spline.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_channel.h"

namespace marey {
namespace {

using DenseMatrix = std::vector<std::vector<long double>>;

/// Solves a X = b by Gaussian elimination with pivots; returns X.
DenseMatrix solve_dense(DenseMatrix a, DenseMatrix b) {
  const std::size_t n = a.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    }
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const long double factor = a[i][k] / a[k][k];
      if (factor == 0.0L) continue;
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      for (std::size_t j = 0; j < b[i].size(); ++j) b[i][j] -= factor * b[k][j];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (long double& value : b[k]) value /= a[k][k];
  }
  return b;
}

/// The influence matrix (W + penalty D' R^-1 D)^-1 W, by dense algebra.
DenseMatrix dense_influence(std::size_t n,
                            int order,
                            double penalty,
                            const std::vector<double>& weights) {
  const auto m = static_cast<std::size_t>(order);
  const std::vector<long double> s = order == 2 ? std::vector<long double>{1, -2, 1}
                                                : std::vector<long double>{-1, 3, -3, 1};
  const std::vector<long double> gram =
      order == 2 ? std::vector<long double>{4.0L / 6, 1.0L / 6}
                 : std::vector<long double>{66.0L / 120, 26.0L / 120, 1.0L / 120};
  DenseMatrix d(n - m, std::vector<long double>(n, 0));
  DenseMatrix r(n - m, std::vector<long double>(n - m, 0));
  for (std::size_t i = 0; i < n - m; ++i) {
    for (std::size_t j = 0; j <= m; ++j) d[i][i + j] = s[j];
    for (std::size_t j = 0; j < n - m; ++j) {
      const std::size_t gap = i > j ? i - j : j - i;
      if (gap < gram.size()) r[i][j] = gram[gap];
    }
  }
  const DenseMatrix rd = solve_dense(r, d);
  DenseMatrix left(n, std::vector<long double>(n, 0));
  DenseMatrix right(n, std::vector<long double>(n, 0));
  for (std::size_t i = 0; i < n; ++i) {
    left[i][i] = right[i][i] = weights[i];
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n - m; ++k) left[i][j] += penalty * d[k][i] * rd[k][j];
    }
  }
  return solve_dense(left, right);
}

std::vector<double> random_weights(std::size_t n) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.1, 2.0);
  std::vector<double> weights(n);
  for (double& weight : weights) weight = unit(random);
  return weights;
}

class SmoothingSplineOfOrder : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, SmoothingSplineOfOrder, ::testing::Values(2, 3));

TEST_P(SmoothingSplineOfOrder, FitAndTraceEqualThoseOfDenseAlgebra) {
  constexpr std::size_t kSamples = 60;
  const SplineOptions options{GetParam()};
  const auto weights = random_weights(kSamples);
  const auto channel =
      testing::with_noise(testing::band_limited(kSamples, 120.0, 8.0, 1), 0.05, 2);
  SmoothingSpline spline(kSamples, options, weights);
  for (const double penalty : {1e-5, 1e-2, 1.0, 100.0, 1e5, 1e8}) {
    const DenseMatrix influence =
        dense_influence(kSamples, options.order, penalty, weights);
    spline.set_penalty(penalty);
    std::vector<double> fitted(kSamples);
    const SplineFit fit = spline.fit(channel, fitted);
    long double trace_of_rest = 0;
    long double squares = 0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      long double value = 0;
      for (std::size_t j = 0; j < kSamples; ++j) value += influence[i][j] * channel[j];
      EXPECT_NEAR(fitted[i], static_cast<double>(value), 1e-9) << penalty;
      trace_of_rest += 1 - influence[i][i];
      squares += weights[i] * (channel[i] - value) * (channel[i] - value);
    }
    EXPECT_NEAR(spline.residual_freedom() / static_cast<double>(trace_of_rest), 1, 1e-8)
        << penalty;
    EXPECT_NEAR(fit.residual_squares / static_cast<double>(squares), 1, 1e-7) << penalty;
    EXPECT_NEAR(
        fit.gcv / static_cast<double>(kSamples * squares / trace_of_rest / trace_of_rest),
        1,
        1e-7);
  }
}

TEST_P(SmoothingSplineOfOrder, ReproducesPolynomialsBelowItsOrder) {
  constexpr std::size_t kSamples = 400;
  const SplineOptions options{GetParam()};
  std::vector<double> channel(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double t = static_cast<double>(i) / 120.0;
    channel[i] = 1.5 - 2.0 * t + (options.order == 3 ? 0.7 * t * t : 0.0);
  }
  SmoothingSpline spline(kSamples, options);
  for (const double penalty : {1e-3, 1e3, max_spline_penalty(options)}) {
    spline.set_penalty(penalty);
    std::vector<double> fitted(kSamples);
    static_cast<void>(spline.fit(channel, fitted));
    for (std::size_t i = 0; i < kSamples; ++i) {
      ASSERT_NEAR(fitted[i], channel[i], 1e-9) << penalty << " " << i;
    }
  }
}

TEST_P(SmoothingSplineOfOrder, LongChannelsKeepTheTraceOfTheirFrequencyResponse) {
  // The trace per sample of a long channel tends to the mean gain over all frequencies.
  constexpr std::size_t kSamples = 36000;
  const SplineOptions options{GetParam()};
  SmoothingSpline spline(kSamples, options);
  for (const double cutoff_hz : {2.0, 6.0, 20.0}) {
    const double penalty = penalty_of_half_power(cutoff_hz, 120.0, options);
    if (penalty > max_spline_penalty(options)) continue;
    spline.set_penalty(penalty);
    double mean_gain = 0.0;
    constexpr int kSteps = 100000;
    for (int k = 0; k < kSteps; ++k) {
      const double w = std::numbers::pi * (k + 0.5) / kSteps;
      const double gram =
          options.order == 2
              ? (4.0 + 2.0 * std::cos(w)) / 6.0
              : (66.0 + 52.0 * std::cos(w) + 2.0 * std::cos(2.0 * w)) / 120.0;
      const double difference = std::pow(2.0 * std::sin(w / 2.0), 2 * options.order);
      mean_gain += 1.0 / (1.0 + penalty * difference / gram) / kSteps;
    }
    const double trace = kSamples - spline.residual_freedom();
    EXPECT_NEAR(trace / (mean_gain * kSamples), 1.0, 2e-3) << cutoff_hz;
  }
}

TEST_P(SmoothingSplineOfOrder, GainIsHalfThePowerAtItsCutOff) {
  constexpr std::size_t kSamples = 2400;
  const SplineOptions options{GetParam()};
  SmoothingSpline spline(kSamples, options);
  for (const double cutoff_hz : {3.0, 6.0, 15.0}) {
    const double penalty = penalty_of_half_power(cutoff_hz, 120.0, options);
    EXPECT_NEAR(half_power_hz(penalty, 120.0, options), cutoff_hz, 1e-9);
    std::vector<double> channel(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i) {
      channel[i] = std::cos(2.0 * std::numbers::pi * cutoff_hz / 120.0 *
                            (static_cast<double>(i) - 1200.0));
    }
    spline.set_penalty(penalty);
    std::vector<double> fitted(kSamples);
    static_cast<void>(spline.fit(channel, fitted));
    EXPECT_NEAR(fitted[1200], std::numbers::sqrt2 / 2.0, 5e-3) << cutoff_hz;
    EXPECT_NEAR(fitted[1201], fitted[1199], 1e-9);  // No phase.
  }
}

TEST_P(SmoothingSplineOfOrder, RecoversTheSigmaOfTheNoise) {
  constexpr std::size_t kSamples = 2400;
  const SplineOptions options{GetParam()};
  const auto truth = testing::band_limited(kSamples, 120.0, 3.0, 3);
  SmoothingSpline spline(kSamples, options);
  spline.set_penalty(penalty_of_half_power(10.0, 120.0, options));
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto channel = testing::with_noise(truth, 0.003, seed);
    std::vector<double> fitted(kSamples);
    EXPECT_NEAR(spline.fit(channel, fitted).noise_sigma, 0.003, 0.0002);
  }
}

TEST_P(SmoothingSplineOfOrder, ASampleOfLittleWeightDoesNotPullTheCurve) {
  constexpr std::size_t kSamples = 240;
  const SplineOptions options{GetParam()};
  const auto truth = testing::band_limited(kSamples, 120.0, 2.0, 4);
  auto channel = truth;
  for (std::size_t i = 100; i < 105; ++i) channel[i] += 0.05;
  std::vector<double> weights(kSamples, 1.0);
  const auto error = [&] {
    SmoothingSpline spline(kSamples, options, weights);
    spline.set_penalty(penalty_of_half_power(8.0, 120.0, options));
    std::vector<double> fitted(kSamples);
    static_cast<void>(spline.fit(channel, fitted));
    return std::abs(fitted[102] - truth[102]);
  };
  EXPECT_GT(error(), 0.02);
  for (std::size_t i = 100; i < 105; ++i) weights[i] = 1e-4;
  EXPECT_LT(error(), 0.002);
}

TEST_P(SmoothingSplineOfOrder, ScoresOfABatchEqualThoseOfSingleFitsToTheBit) {
  constexpr std::size_t kSamples = 301;
  std::vector<std::vector<double>> channels;
  for (unsigned seed = 0; seed < 7; ++seed) {
    channels.push_back(testing::with_noise(
        testing::band_limited(kSamples, 120.0, 6.0, seed), 0.002, seed));
  }
  const std::vector<std::span<const double>> views(channels.begin(), channels.end());
  SmoothingSpline spline(kSamples, {GetParam()}, random_weights(kSamples));
  spline.set_penalty(30.0);
  std::vector<SplineFit> scores(channels.size());
  spline.score(views, scores);
  std::vector<double> fitted(kSamples);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const SplineFit fit = spline.fit(channels[k], fitted);
    EXPECT_EQ(fit.gcv, scores[k].gcv);
    EXPECT_EQ(fit.residual_squares, scores[k].residual_squares);
  }
}

TEST_P(SmoothingSplineOfOrder, FitsAndScoresAllocateNothing) {
  constexpr std::size_t kSamples = 301;
  const auto channel =
      testing::with_noise(testing::band_limited(kSamples, 120.0, 6.0, 1), 0.002, 1);
  const std::vector<std::span<const double>> views(6, channel);
  std::vector<double> fitted(kSamples);
  std::vector<SplineFit> scores(views.size());
  SmoothingSpline spline(kSamples, {GetParam()});
  const long before = marey::testing::allocations();
  spline.set_penalty(30.0);
  static_cast<void>(spline.fit(channel, fitted));
  spline.score(views, scores);
  EXPECT_EQ(marey::testing::allocations(), before);
}

}  // namespace
}  // namespace marey
