// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/sync/number_gaps.h"

#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace marey::capture {
namespace {

using Names = std::vector<std::filesystem::path>;

/// Twenty images, numbered by `number`.
Names images(const std::function<long(long)>& number) {
  Names names;
  for (long i = 0; i < 20; ++i) {
    names.emplace_back("run2_img" + std::to_string(number(i)) + ".png");
  }
  return names;
}

TEST(NumberGap, IsNotFoundInEvenNumbers) {
  EXPECT_FALSE(find_number_gap(images([](long i) { return 7 + i; })));
  EXPECT_FALSE(find_number_gap(images([](long i) { return 5 * i; }))) << "every fifth";
  EXPECT_FALSE(find_number_gap(Names{"a.png", "b.png"}));
  EXPECT_FALSE(find_number_gap({}));
}

TEST(NumberGap, IsFoundWithItsNeighbours) {
  const auto gap =
      find_number_gap(images([](long i) { return i < 12 ? 100 + i : 103 + i; }));
  ASSERT_TRUE(gap);
  EXPECT_EQ(gap->before, "run2_img111.png");
  EXPECT_EQ(gap->after, "run2_img115.png");
  EXPECT_EQ(gap->missing, 3);
  EXPECT_EQ(gap->gaps, 1);
}

TEST(NumberGap, IsNotSuspectedOfTimeStamps) {
  EXPECT_FALSE(find_number_gap(
      images([](long i) { return 1'000'000'000L + 33'333'333L * i + i * i % 7; })));
  EXPECT_FALSE(find_number_gap(images([](long i) {
    return i < 12 ? 33 * i : 33 * i + 5;
  }))) << "no multiple";
}

}  // namespace
}  // namespace marey::capture
