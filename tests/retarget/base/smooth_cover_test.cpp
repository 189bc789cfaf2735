// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/base/smooth_cover.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

TEST(SmoothCover, IsNeverBelowWhatIsNeeded) {
  testing::Dice dice(1);
  std::vector<double> needed(300, 0.0);
  for (std::size_t i = 40; i < 200; ++i)
    needed[i] = std::max(dice.between(-2.0, 1.0), 0.0);
  for (const int half : {0, 1, 5, 20}) {
    const std::vector<double> cover = smooth_cover(needed, half);
    for (std::size_t i = 0; i < needed.size(); ++i)
      EXPECT_GE(cover[i], needed[i] - 1e-15);
  }
}

TEST(SmoothCover, LeavesAloneWhatIsFarAway) {
  std::vector<double> needed(100, 0.0);
  needed[50] = 1.0;
  const std::vector<double> cover = smooth_cover(needed, 10);
  EXPECT_EQ(cover[29], 0.0);
  EXPECT_GT(cover[31], 0.0);
  EXPECT_EQ(cover[71], 0.0);
  EXPECT_NEAR(cover[50], 1.0, 1e-15);
}

// A step of 1 over 2 half frames: no second difference beyond 1.9 / half^2; the step
// itself has 1.
TEST(SmoothCover, HasASmallSecondDifference) {
  std::vector<double> needed(200, 0.0);
  std::fill(needed.begin() + 100, needed.end(), 1.0);
  const std::vector<double> cover = smooth_cover(needed, 20);
  for (std::size_t i = 1; i + 1 < cover.size(); ++i) {
    EXPECT_LT(std::abs(cover[i - 1] - 2.0 * cover[i] + cover[i + 1]), 1.9 / 400.0);
  }
}

TEST(SmoothCover, TakesNothing) {
  EXPECT_TRUE(smooth_cover({}, 3).empty());
}

}  // namespace
}  // namespace marey::retarget
