// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/warp_distance.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/library/moved_motion.h"
#include "tests/library/search/plain_warp.h"
#include "tests/support/program/count_allocations.h"

namespace marey::library {
namespace {

std::vector<float> warp_part(const std::vector<float>& rows, int first, int count) {
  return {rows.begin() + 64 * first, rows.begin() + 64 * (first + count)};
}

void compare_with_all_paths(int n, int m, bool whole, std::uint64_t seed) {
  const std::vector<float> query = random_rows(seed, n);
  const std::vector<float> clip = random_rows(seed + 1000, m);
  const PlainWarp truth = PlainAligner(query, clip, whole).best();
  WarpScratch scratch;
  const auto match = warp_distance(
      query, clip, whole ? WarpEnds::kWhole : WarpEnds::kSubsequence, scratch);
  ASSERT_EQ(match.has_value(), truth.last_row >= 0) << n << " rows against " << m;
  if (!match) return;
  EXPECT_NEAR(match->distance, truth.sum / (whole ? std::max(n, m) : n), 1e-5);
  EXPECT_EQ(match->first_row, truth.first_row);
  EXPECT_EQ(match->last_row, truth.last_row);
}

TEST(WarpDistance, IsTheLeastOfAllPaths) {
  for (int n = 1; n <= 8; ++n) {
    for (int m = 1; m <= 10; ++m) {
      for (int seed = 0; seed < 3; ++seed) {
        const auto number = static_cast<std::uint64_t>(200 * seed + 11 * n + m);
        compare_with_all_paths(n, m, false, number);
        compare_with_all_paths(n, m, true, number);
      }
    }
  }
}

TEST(WarpDistance, FindsAPartOfTheClipItself) {
  const std::vector<float> clip = random_rows(1, 80);
  WarpScratch scratch;
  const auto match =
      warp_distance(warp_part(clip, 31, 21), clip, WarpEnds::kSubsequence, scratch);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->distance, 0.0);
  EXPECT_EQ(match->first_row, 31);
  EXPECT_EQ(match->last_row, 51);
  const auto whole = warp_distance(clip, clip, WarpEnds::kWhole, scratch);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->distance, 0.0);
}

// A query of every second row of the clip: just within the twofold stretch.
TEST(WarpDistance, FollowsAMotionOfAnotherSpeed) {
  const std::vector<float> slow = random_rows(2, 60);
  std::vector<float> fast;
  for (int k = 10; k <= 30; k += 2) {
    fast.insert(fast.end(), slow.begin() + 64 * k, slow.begin() + 64 * (k + 1));
  }
  WarpScratch scratch;
  const auto match = warp_distance(fast, slow, WarpEnds::kSubsequence, scratch);
  ASSERT_TRUE(match);
  const auto at_half =
      warp_distance(fast, warp_part(slow, 10, 21), WarpEnds::kWhole, scratch);
  ASSERT_TRUE(at_half);
  // The passed rows of the clip count, too: 21 cells for 11 rows of the query.
  EXPECT_LE(match->distance * 11.0, at_half->distance * 21.0 + 1e-4);
}

// Rows by letter: equal letters are equal rows.
std::vector<float> lettered_rows(const std::string& letters) {
  std::vector<float> out;
  for (const char letter : letters) {
    const std::vector<float> row = random_rows(static_cast<std::uint64_t>(letter), 1);
    out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

TEST(WarpDistance, NamesTheRowsThatAreAligned) {
  struct Case {
    const char* query;
    const char* clip;
    int first_row;
    int last_row;
  };
  for (const Case& c : {Case{"abc", "zabbc", 1, 4},    // One step (1,2).
                        Case{"abbc", "zzabc", 2, 4},   // One step (2,1).
                        Case{"aab", "aaab", 1, 3},     // (1,1) before (1,2).
                        Case{"ab", "abzab", 0, 1}}) {  // The earliest end.
    WarpScratch scratch;
    const auto match = warp_distance(
        lettered_rows(c.query), lettered_rows(c.clip), WarpEnds::kSubsequence, scratch);
    ASSERT_TRUE(match);
    EXPECT_EQ(match->distance, 0.0) << c.query;
    EXPECT_EQ(match->first_row, c.first_row) << c.query;
    EXPECT_EQ(match->last_row, c.last_row) << c.query;
  }
}

// Bounds at, above and below the distance.
TEST(WarpDistance, StopsEarlyWithoutAnotherResult) {
  WarpScratch scratch;
  for (int seed = 0; seed < 40; ++seed) {
    const std::vector<float> query = random_rows(static_cast<std::uint64_t>(seed), 21);
    const std::vector<float> clip =
        random_rows(static_cast<std::uint64_t>(seed) + 500, 25 + seed);
    for (const WarpEnds ends : {WarpEnds::kSubsequence, WarpEnds::kWhole}) {
      const auto unbounded = warp_distance(query, clip, ends, scratch);
      if (!unbounded) continue;
      for (const double factor : {0.3, 0.9, 0.999999, 1.0, 1.000001, 1.5}) {
        const double bound = unbounded->distance * factor;
        const auto bounded = warp_distance(query, clip, ends, scratch, bound);
        EXPECT_EQ(bounded.has_value(), unbounded->distance <= bound);
        if (!bounded) continue;
        EXPECT_EQ(bounded->distance, unbounded->distance);
        EXPECT_EQ(bounded->first_row, unbounded->first_row);
        EXPECT_EQ(bounded->last_row, unbounded->last_row);
      }
    }
  }
}

TEST(WarpDistance, AllocatesForALongerClipOnly) {
  WarpScratch scratch;
  const std::vector<float> query = random_rows(1, 21);
  const std::vector<float> clip = random_rows(2, 90);
  (void)warp_distance(query, clip, WarpEnds::kSubsequence, scratch);
  const long before = testing::allocations();
  (void)warp_distance(query, clip, WarpEnds::kSubsequence, scratch);
  (void)warp_distance(query, query, WarpEnds::kWhole, scratch);
  EXPECT_EQ(testing::allocations(), before);
}

TEST(WarpDistance, DeclinesClipsBeyondTwofoldStretch) {
  WarpScratch scratch;
  const std::vector<float> rows = random_rows(3, 50);
  const auto aligns = [&](int n, int m, WarpEnds ends) {
    return warp_distance(warp_part(rows, 0, n), warp_part(rows, 0, m), ends, scratch)
        .has_value();
  };
  EXPECT_TRUE(aligns(21, 11, WarpEnds::kSubsequence));
  EXPECT_FALSE(aligns(22, 11, WarpEnds::kSubsequence));
  EXPECT_TRUE(aligns(10, 19, WarpEnds::kWhole));
  EXPECT_FALSE(aligns(10, 20, WarpEnds::kWhole));
  EXPECT_FALSE(aligns(3, 0, WarpEnds::kSubsequence));
  EXPECT_TRUE(aligns(1, 1, WarpEnds::kWhole));
}

}  // namespace
}  // namespace marey::library
