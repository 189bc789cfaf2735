// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/signal/butterworth.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_channel.h"

namespace marey::edit {
namespace {

/// Complex gain of both passes at a frequency, from the middle of a long sine and cosine.
struct Gain {
  double even = 0.0;  ///< Part in phase.
  double odd = 0.0;   ///< Part in quadrature.
};

Gain measured_gain(double frequency_hz, double cutoff_hz, double rate_hz) {
  constexpr std::size_t kSamples = 4001;
  std::vector<double> cosine(kSamples);
  std::vector<double> sine(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double phase = 2.0 * std::numbers::pi * frequency_hz *
                         (static_cast<double>(i) - 2000.0) / rate_hz;
    cosine[i] = std::cos(phase);
    sine[i] = std::sin(phase);
  }
  filter_butterworth(cosine, cutoff_hz, rate_hz);
  filter_butterworth(sine, cutoff_hz, rate_hz);
  return {cosine[2000], sine[2000]};
}

TEST(Butterworth, GainIs0707AtTheCutOffAfterBothPassesAndWithoutPhase) {
  for (const double rate_hz : {30.0, 120.0, 250.0}) {
    for (const double cutoff_hz : {0.02, 0.05, 0.15, 0.3, 0.45}) {
      const Gain gain = measured_gain(cutoff_hz * rate_hz, cutoff_hz * rate_hz, rate_hz);
      EXPECT_NEAR(gain.even, std::numbers::sqrt2 / 2.0, 1e-9) << rate_hz << cutoff_hz;
      EXPECT_NEAR(gain.odd, 0.0, 1e-9);
    }
  }
}

TEST(Butterworth, RollsOffAsTheFourthOrder) {
  // Gain 1 / (1 + 0.414 (w / w_c)^4), with warped frequencies.
  for (const double frequency_hz : {2.0, 10.0, 20.0, 40.0}) {
    const double ratio = std::tan(std::numbers::pi * frequency_hz / 120.0) /
                         std::tan(std::numbers::pi * 6.0 / 120.0);
    const double expected =
        1.0 / (1.0 + (std::numbers::sqrt2 - 1.0) * std::pow(ratio, 4));
    EXPECT_NEAR(measured_gain(frequency_hz, 6.0, 120.0).even, expected, 1e-9);
  }
}

TEST(Butterworth, KeepsStraightLinesUpToTheEnds) {
  std::vector<double> constant(50, 0.8);
  filter_butterworth(constant, 6.0, 120.0);
  for (const double value : constant) EXPECT_NEAR(value, 0.8, 1e-13);

  std::vector<double> line(240);
  for (std::size_t i = 0; i < line.size(); ++i) line[i] = 0.01 * static_cast<double>(i);
  const auto source = line;
  filter_butterworth(line, 6.0, 120.0);
  for (std::size_t i = 0; i < line.size(); ++i) {
    EXPECT_NEAR(line[i], source[i], 3e-4 /* of a slope of 0.01 per sample */) << i;
  }
  EXPECT_NEAR(line[120], source[120], 1e-10);
}

TEST(Butterworth, ShortChannelsAreFilteredOrLeft) {
  std::vector<double> none;
  filter_butterworth(none, 6.0, 120.0);
  std::vector<double> one{0.3};
  filter_butterworth(one, 6.0, 120.0);
  EXPECT_EQ(one[0], 0.3);
  std::vector<double> three{0.0, 1.0, 0.0};
  filter_butterworth(three, 6.0, 120.0);
  for (const double value : three) EXPECT_TRUE(std::isfinite(value));
}

TEST(Butterworth, YusCutOffIs8Point1HzAt120Hz) {
  EXPECT_NEAR(yu_cutoff_hz(120.0), 8.088, 1e-9);
}

TEST(Butterworth, ResidualAnalysisFindsACutOffAboveTheBandAndNearTheBest) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto truth = testing::band_limited(1200, 120.0, 4.0, seed);
    const auto channel = testing::with_noise(truth, 0.002, seed);
    const auto error = [&](double cutoff_hz) {
      auto filtered = channel;
      filter_butterworth(filtered, cutoff_hz, 120.0);
      return testing::rms_difference(filtered, truth);
    };
    const auto cutoff_hz = winter_cutoff_hz(channel, 120.0);
    ASSERT_TRUE(cutoff_hz);
    double best = 1e9;
    for (double f = 1.0; f < 30.0; f += 0.25) best = std::min(best, error(f));
    EXPECT_LT(error(*cutoff_hz), 1.7 * best) << *cutoff_hz;
  }
}

TEST(Butterworth, ResidualAnalysisDeclinesShortAndConstantChannels) {
  EXPECT_FALSE(winter_cutoff_hz(std::vector<double>(19, 0.0), 120.0));
  EXPECT_FALSE(winter_cutoff_hz(std::vector<double>(400, 0.7), 120.0));
}

}  // namespace
}  // namespace marey::edit
