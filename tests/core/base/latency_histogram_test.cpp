// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/latency_histogram.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(LatencyHistogram, KnowsQuantilesToTwoPercent) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> durations(std::log(0.012), 0.8);
  std::vector<double> all;
  LatencyHistogram histogram;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(durations(random));
    histogram.add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.01, 0.5, 0.95, 0.999}) {
    const double exact = all[static_cast<std::size_t>(share * 20000.0) - 1];
    EXPECT_NEAR(histogram.quantile_s(share) / exact, 1.0, 0.0201) << share;
  }
  EXPECT_EQ(histogram.max_s(), all.back());
  EXPECT_EQ(histogram.quantile_s(1.0), all.back());
  EXPECT_EQ(histogram.count(), 20000);
}

TEST(LatencyHistogram, IsEmptyWithoutDurationsAndCountsValuesOutOfRange) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile_s(0.5), 0.0);
  histogram.add(-1.0);
  EXPECT_LE(histogram.quantile_s(0.5), 1e-6);
  histogram.add(1e9);
  EXPECT_EQ(histogram.max_s(), 1e9);
  histogram.clear();
  EXPECT_EQ(histogram.count(), 0);
}

}  // namespace
}  // namespace marey
