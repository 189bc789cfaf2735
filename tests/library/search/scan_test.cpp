// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/scan.h"

#include <algorithm>
#include <cstring>

#include "library/search/row_kernel.h"
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::library {
namespace {

std::vector<float> random_values(std::uint64_t seed, std::size_t count) {
  testing::Dice dice(seed);
  std::vector<float> out(count);
  for (float& v : out) v = static_cast<float>(dice.noise(1.0));
  return out;
}

double plain_distance(const float* a, const float* b, std::size_t count) {
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    sum += (static_cast<double>(a[k]) - b[k]) * (static_cast<double>(a[k]) - b[k]);
  }
  return sum;
}

TEST(RowKernel, GivesTheSameBitsForEveryWidth) {
  for (const std::size_t columns : {16U, 64U, 128U}) {
    const std::vector<float> rows = random_values(1, 37 * columns);
    const std::vector<float> query = random_values(2, columns);
    std::vector<float> truth(37);
    squared_distances(RowLanes::kOne)(
        rows.data(), 37, columns, query.data(), truth.data());
    for (std::size_t r = 0; r < 37; ++r) {
      const double plain =
          plain_distance(rows.data() + r * columns, query.data(), columns);
      EXPECT_NEAR(truth[r], plain, 1e-6 * plain);
    }
    for (const RowLanes lanes : {RowLanes::kFour, RowLanes::kEight}) {
      if (!has_row_lanes(lanes)) continue;
      std::vector<float> out(37);
      squared_distances(lanes)(rows.data(), 37, columns, query.data(), out.data());
      EXPECT_EQ(std::memcmp(out.data(), truth.data(), 37 * sizeof(float)), 0);
    }
  }
}

TEST(Scan, FindsTheNearestRowOfEachClip) {
  testing::Dice dice(3);
  std::vector<std::uint64_t> begins{0};
  for (int clip = 0; clip < 40; ++clip) {
    // Some clips have no rows, one has more than are compared at once.
    const double size = clip == 7 ? 700.0 : std::max(0.0, dice.between(-3.0, 12.0));
    begins.push_back(begins.back() + static_cast<std::uint64_t>(size));
  }
  const std::vector<float> rows = random_values(4, begins.back() * 64);
  const std::vector<float> query = random_values(5, 64);
  std::vector<ScanHit> hits = nearest_rows({rows, 64, begins}, query);
  std::size_t next = 0;
  for (std::size_t clip = 0; clip < 40; ++clip) {
    if (begins[clip] == begins[clip + 1]) continue;
    ASSERT_LT(next, hits.size());
    double least = 1e30;
    std::uint64_t best = 0;
    for (std::uint64_t r = begins[clip]; r < begins[clip + 1]; ++r) {
      const double d = plain_distance(rows.data() + r * 64, query.data(), 64);
      if (d < least) best = r - begins[clip];
      least = std::min(least, d);
    }
    EXPECT_EQ(hits[next].clip, static_cast<int>(clip));
    EXPECT_EQ(hits[next].row, static_cast<int>(best));
    EXPECT_NEAR(hits[next].squared_distance, least, 1e-5 * least);
    ++next;
  }
  EXPECT_EQ(next, hits.size());

  const std::vector<ScanHit> all = hits;
  keep_nearest(hits, 10);
  ASSERT_EQ(hits.size(), 10U);
  EXPECT_TRUE(std::is_sorted(hits.begin(), hits.end(), [](const auto& a, const auto& b) {
    return a.squared_distance < b.squared_distance;
  }));
  EXPECT_EQ(std::count_if(all.begin(),
                          all.end(),
                          [&](const ScanHit& h) {
                            return h.squared_distance <= hits.back().squared_distance;
                          }),
            10);
}

TEST(Scan, BreaksTiesByClipAndByRow) {
  // Eight clips of three equal rows.
  const std::vector<float> rows(8 * 3 * 16, 1.0F);
  std::vector<std::uint64_t> begins;
  for (std::uint64_t k = 0; k <= 8; ++k) begins.push_back(3 * k);
  std::vector<ScanHit> hits =
      nearest_rows({rows, 16, begins}, std::vector<float>(16, 0.0F));
  std::reverse(hits.begin(), hits.end());
  keep_nearest(hits, 5);
  ASSERT_EQ(hits.size(), 5U);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(hits[static_cast<std::size_t>(k)].clip, k);
    EXPECT_EQ(hits[static_cast<std::size_t>(k)].row, 0);
  }
}

TEST(Scan, AcceptsEmptyLibraries) {
  const std::vector<float> query(64, 0.0F);
  EXPECT_TRUE(nearest_rows({{}, 64, {}}, query).empty());
  const std::vector<std::uint64_t> begins{0, 0, 0};
  EXPECT_TRUE(nearest_rows({{}, 64, begins}, query).empty());
  std::vector<ScanHit> none;
  keep_nearest(none, 10);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace marey::library
