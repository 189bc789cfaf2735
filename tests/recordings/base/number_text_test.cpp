// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/number_text.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/text_reader.h"

namespace marey::recordings {
namespace {

std::string fixed(double value, int decimals = 6) {
  std::string text;
  append_fixed(text, value, decimals);
  return text;
}

TEST(AppendFixed, RoundsToItsDecimals) {
  EXPECT_EQ(fixed(-1.23456789), "-1.234568");
  EXPECT_EQ(fixed(2.0, 0), "2");
}

TEST(AppendFixed, WritesZeroWithoutASign) {
  EXPECT_EQ(fixed(-1e-9), "0.000000");
  EXPECT_EQ(fixed(-0.0, 0), "0");
  EXPECT_EQ(fixed(-1e-6), "-0.000001");
}

TEST(AppendFixed, HoldsTheLargestDouble) {
  EXPECT_EQ(fixed(-std::numeric_limits<double>::max(), 20).size(), 331U);
}

TEST(AppendExact, IsReadBackBitForBit) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 10'000; ++i) {
    const double value = std::ldexp(static_cast<double>(random()) - 9e18,
                                    static_cast<int>(random() % 400) - 200);
    std::string text;
    append_exact(text, value);
    EXPECT_EQ(to_number(text), value);
  }
}

}  // namespace
}  // namespace marey::recordings
