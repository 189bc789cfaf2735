// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/quantile.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(Median, IsTheMiddleOfAnOddCountInAnyOrder) {
  EXPECT_EQ(median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median({7.0}), 7.0);
}

TEST(Median, IsTheUpperMiddleOfAnEvenCount) {
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 3.0);
}

TEST(Median, IsNotMovedByAFewWildValues) {
  EXPECT_EQ(median({1.0, 2.0, 3.0, 1e300, 1e300}), 3.0);
}

TEST(Quantile, GivesTheValueThatFarUpTheOrder) {
  std::vector<double> hundred_and_one;
  for (int i = 100; i >= 0; --i) hundred_and_one.push_back(i);
  EXPECT_EQ(quantile(hundred_and_one, 0.95), 95.0);
  EXPECT_EQ(quantile(hundred_and_one, 0.254), 25.0);
  EXPECT_EQ(quantile(hundred_and_one, 0.255), 26.0);
}

TEST(Quantile, RunsFromTheMinimumToTheMaximum) {
  const std::vector<double> values{2.0, 9.0, 4.0};
  EXPECT_EQ(quantile(values, 0.0), 2.0);
  EXPECT_EQ(quantile(values, 1.0), 9.0);
}

TEST(QuantileDeathTest, MedianOfAnEmptyRangeBreaksTheContract) {
  EXPECT_DEATH((void)median({}), "contract broken");
}

}  // namespace
}  // namespace marey
