// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/choose_smoothing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_channel.h"

namespace marey {
namespace {

constexpr double kChooseRate_hz = 120.0;

std::vector<double> own_penalties(const std::vector<std::vector<double>>& channels,
                                  SplineOptions options) {
  SmoothingChannels smoothing{{SmoothingSpline(channels.front().size(), options)},
                              {channels.begin(), channels.end()},
                              std::vector<std::size_t>(channels.size(), 0)};
  return choose_penalties(smoothing, {}).channels;
}

class ChooseSmoothingOfOrder : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Orders, ChooseSmoothingOfOrder, ::testing::Values(2, 3));

TEST_P(ChooseSmoothingOfOrder, ErrorIsWithinATenthOfTheBestPenaltys) {
  constexpr std::size_t kSamples = 480;
  const SplineOptions options{GetParam()};
  SmoothingSpline spline(kSamples, options);
  std::vector<double> fitted(kSamples);
  double sum = 0.0;
  double worst = 0.0;
  constexpr unsigned kSeeds = 60;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const double band_hz = 3.0 + 0.2 * seed;
    const double sigma = seed % 2 == 0 ? 0.001 : 0.005;
    const auto truth = testing::band_limited(kSamples, kChooseRate_hz, band_hz, seed);
    const auto channel = testing::with_noise(truth, sigma, 1000 + seed);
    const auto error = [&](double penalty) {
      spline.set_penalty(penalty);
      static_cast<void>(spline.fit(channel, fitted));
      return testing::rms_difference(fitted, truth);
    };
    double best = 1e9;
    for (double cutoff_hz = 1.5; cutoff_hz < 50.0; cutoff_hz *= 1.04) {
      best = std::min(best,
                      error(penalty_of_half_power(cutoff_hz, kChooseRate_hz, options)));
    }
    const double ratio = error(own_penalties({channel}, options)[0]) / best;
    sum += ratio;
    worst = std::max(worst, ratio);
  }
  EXPECT_LT(sum / kSeeds, 1.05);
  EXPECT_LT(worst, 1.4);  // A channel of 480 samples alone; groups average.
  RecordProperty("mean", std::to_string(sum / kSeeds));
}

TEST_P(ChooseSmoothingOfOrder, FindsTheMinimumOfADenseScan) {
  constexpr std::size_t kSamples = 600;
  const SplineOptions options{GetParam()};
  const auto channel = testing::with_noise(
      testing::band_limited(kSamples, kChooseRate_hz, 7.0, 1), 0.002, 1);
  SmoothingSpline spline(kSamples, options);
  std::vector<double> fitted(kSamples);
  double best_hz = 0.0;
  double best = 1e9;
  for (double cutoff_hz = 1.5; cutoff_hz < 100.0; cutoff_hz *= 1.002) {
    spline.set_penalty(penalty_of_half_power(cutoff_hz, kChooseRate_hz, options));
    const double gcv = spline.fit(channel, fitted).gcv;
    if (gcv < best) {
      best = gcv;
      best_hz = cutoff_hz;
    }
  }
  const double found =
      half_power_hz(own_penalties({channel}, options)[0], kChooseRate_hz, options);
  EXPECT_NEAR(found / best_hz, 1.0, 0.01);
}

TEST(ChooseSmoothing, PenaltyDoesNotDependOnUnitOffsetOrOtherChannels) {
  constexpr std::size_t kSamples = 600;
  const auto channel = testing::with_noise(
      testing::band_limited(kSamples, kChooseRate_hz, 5.0, 1), 0.002, 1);
  auto scaled = channel;
  for (double& value : scaled) value = 1000.0 * value + 4000.0;
  const auto other = testing::with_noise(
      testing::band_limited(kSamples, kChooseRate_hz, 15.0, 2), 0.001, 2);
  const double alone = own_penalties({channel}, {})[0];
  const auto together = own_penalties({other, scaled, channel}, {});
  EXPECT_EQ(together[2], alone);
  EXPECT_NEAR(together[1] / alone, 1.0, 1e-6);
}

TEST(ChooseSmoothing, MedianOfAGroupIsThatOfItsChannelsPenalties) {
  constexpr std::size_t kSamples = 600;
  std::vector<std::vector<double>> channels;
  for (unsigned i = 0; i < 5; ++i) {
    channels.push_back(testing::with_noise(
        testing::band_limited(kSamples, kChooseRate_hz, 3.0 + 2.0 * i, i), 0.002, i));
  }
  auto smoothed = channels;
  const std::vector<std::vector<std::size_t>> groups{{0, 1, 2}, {4}};
  const auto report =
      smooth_groups(smoothed, groups, kChooseRate_hz, {{}, GroupRule::kMedian});
  std::vector<double> own;
  for (const std::size_t i : groups[0]) own.push_back(report.channels[i].own_penalty);
  std::sort(own.begin(), own.end());
  ASSERT_TRUE(report.groups[0].penalty);
  EXPECT_EQ(*report.groups[0].penalty, own[1]);
  EXPECT_EQ(*report.groups[1].penalty, report.channels[4].own_penalty);
  EXPECT_EQ(smoothed[3], channels[3]);  // In no group.
  SmoothingSpline spline(kSamples);
  spline.set_penalty(own[1]);
  std::vector<double> fitted(kSamples);
  static_cast<void>(spline.fit(channels[1], fitted));
  EXPECT_EQ(smoothed[1], fitted);
  EXPECT_NEAR(report.channels[1].noise_sigma, 0.002, 0.0003);
  EXPECT_NEAR(report.channels[1].removed_rms,
              testing::rms_difference(channels[1], smoothed[1]),
              1e-15);
  const std::size_t at = report.channels[1].removed_max_sample;
  EXPECT_EQ(std::abs(channels[1][at] - smoothed[1][at]), report.channels[1].removed_max);
}

TEST(ChooseSmoothing, JointPenaltyOfAGroupSparesItsFastestChannel) {
  // Two slow channels and a fast one: the median smooths the fast one too much.
  constexpr std::size_t kSamples = 1200;
  const std::vector<std::vector<double>> truth{
      testing::band_limited(kSamples, kChooseRate_hz, 2.0, 1),
      testing::band_limited(kSamples, kChooseRate_hz, 2.0, 2),
      testing::band_limited(kSamples, kChooseRate_hz, 14.0, 3)};
  auto joint = truth;
  for (unsigned i = 0; i < 3; ++i) joint[i] = testing::with_noise(truth[i], 0.001, i);
  auto by_median = joint;
  const std::vector<std::vector<std::size_t>> groups{{0, 1, 2}};
  const auto report = smooth_groups(joint, groups, kChooseRate_hz);
  static_cast<void>(
      smooth_groups(by_median, groups, kChooseRate_hz, {{}, GroupRule::kMedian}));
  EXPECT_LT(testing::rms_difference(joint[2], truth[2]), 0.001);
  EXPECT_GT(testing::rms_difference(by_median[2], truth[2]), 0.002);
  EXPECT_LT(*report.groups[0].penalty, report.channels[0].own_penalty);
}

TEST(ChooseSmoothing, AChannelWithoutNoiseDoesNotPreventSmoothingTheOthers) {
  constexpr std::size_t kSamples = 1200;
  const std::vector<std::vector<double>> truth{
      testing::band_limited(kSamples, kChooseRate_hz, 4.0, 1),
      testing::band_limited(kSamples, kChooseRate_hz, 4.0, 2),
      testing::band_limited(kSamples, kChooseRate_hz, 4.0, 3)};
  auto channels = truth;
  for (unsigned i = 0; i < 2; ++i) {
    channels[i] = testing::with_noise(truth[i], 0.003, i);
  }
  const std::vector<std::vector<std::size_t>> groups{{0, 1, 2}};
  static_cast<void>(smooth_groups(channels, groups, kChooseRate_hz));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(testing::rms_difference(channels[i], truth[i]), 0.0012);
  }
}

TEST(ChooseSmoothing, ShortAndStraightChannelsAreReportedAndLeftAsTheyAre) {
  std::vector<std::vector<double>> shorts(2, std::vector<double>{1, 3, 2, 5, 4});
  const auto before = shorts;
  const std::vector<std::vector<std::size_t>> groups{{0, 1}};
  const auto report = smooth_groups(shorts, groups, kChooseRate_hz);
  EXPECT_EQ(shorts, before);
  EXPECT_FALSE(report.groups[0].penalty);
  EXPECT_EQ(report.channels[0].state, SmoothingState::kTooShort);

  constexpr std::size_t kSamples = 200;
  std::vector<std::vector<double>> channels(3, std::vector<double>(kSamples, 0.7));
  for (std::size_t i = 0; i < kSamples; ++i) {
    channels[1][i] = 1.0 + 0.003 * static_cast<double>(i);
  }
  channels[2] = testing::with_noise(
      testing::band_limited(kSamples, kChooseRate_hz, 5.0, 1), 0.002, 1);
  const auto source = channels;
  const std::vector<std::vector<std::size_t>> all{{0, 1, 2}};
  const auto second = smooth_groups(channels, all, kChooseRate_hz);
  EXPECT_EQ(second.channels[0].state, SmoothingState::kStraight);
  EXPECT_EQ(second.channels[1].state, SmoothingState::kStraight);
  EXPECT_EQ(second.channels[2].state, SmoothingState::kSmoothed);
  EXPECT_EQ(channels[0], source[0]);
  EXPECT_EQ(channels[1], source[1]);
  EXPECT_NE(channels[2], source[2]);
  EXPECT_EQ(*second.groups[0].penalty, second.channels[2].own_penalty);
}

TEST(ChooseSmoothing, ChannelsHaveTheirOwnWeights) {
  // A jump of 5 cm in frames of little weight; only the second channel has the weights.
  constexpr std::size_t kSamples = 600;
  const auto truth = testing::band_limited(kSamples, kChooseRate_hz, 2.0, 1);
  std::vector<std::vector<double>> channels(3, testing::with_noise(truth, 0.002, 1));
  std::vector<std::vector<double>> weights(3);
  weights[1].assign(kSamples, 1.0);
  for (std::size_t i = 300; i < 306; ++i) {
    channels[0][i] += 0.05;
    channels[1][i] += 0.05;
    weights[1][i] = 1e-3;
  }
  const std::vector<std::vector<std::size_t>> groups{{0}, {1}, {2}};
  static_cast<void>(smooth_groups(channels, groups, kChooseRate_hz, {}, weights));
  EXPECT_GT(std::abs(channels[0][303] - truth[303]), 0.02);
  EXPECT_LT(std::abs(channels[1][303] - truth[303]), 0.003);
  EXPECT_LT(std::abs(channels[2][303] - truth[303]), 0.003);
}

TEST(ChooseSmoothing, AGroupMayMixWeights) {
  constexpr std::size_t kSamples = 600;
  std::vector<std::vector<double>> channels;
  for (unsigned i = 0; i < 4; ++i) {
    channels.push_back(testing::with_noise(
        testing::band_limited(kSamples, kChooseRate_hz, 4.0, i), 0.002, i));
  }
  auto unweighted = channels;
  std::vector<std::vector<double>> weights(4);
  weights[2].assign(kSamples, 1.0);  // Equal to none.
  weights[3].assign(kSamples, 7.0);  // A common factor changes the penalty alone.
  const std::vector<std::vector<std::size_t>> groups{{0, 1, 2}, {3}};
  const auto report = smooth_groups(channels, groups, kChooseRate_hz, {}, weights);
  const auto reference = smooth_groups(unweighted, groups, kChooseRate_hz);
  EXPECT_EQ(*report.groups[0].penalty, *reference.groups[0].penalty);
  EXPECT_EQ(channels[2], unweighted[2]);
  EXPECT_NEAR(*report.groups[1].penalty / *reference.groups[1].penalty, 7.0, 0.02);
  EXPECT_LT(testing::rms_difference(channels[3], unweighted[3]), 1e-5);
}

TEST(ChooseSmoothing, AnEmptyListOfChannelsIsNoError) {
  std::vector<std::vector<double>> none;
  const std::vector<std::vector<std::size_t>> groups{{}};
  const auto report = smooth_groups(none, groups, kChooseRate_hz);
  EXPECT_FALSE(report.groups[0].penalty);
}

}  // namespace
}  // namespace marey
