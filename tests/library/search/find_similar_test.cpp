// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/find_similar.h"

#include <algorithm>
#include <array>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"
#include "library/search/warp_distance.h"
#include <gtest/gtest.h>

#include "tests/library/moved_motion.h"

namespace marey::library {
namespace {

// A library in memory.
struct MadeLibrary {
  std::array<std::vector<float>, 3> values;
  std::array<std::vector<std::uint64_t>, 3> begins{{{0}, {0}, {0}}};
  std::vector<std::vector<float>> clips;

  void add(const std::vector<float>& rows) {
    clips.push_back(rows);
    const std::array<std::vector<float>, 3> parts{
        rows, feature_windows(rows), whole_clip_row(rows)};
    constexpr std::size_t kColumns[] = {kFeatureStride, kWindowFloats, kWholeFloats};
    for (std::size_t k = 0; k < 3; ++k) {
      values[k].insert(values[k].end(), parts[k].begin(), parts[k].end());
      begins[k].push_back(values[k].size() / kColumns[k]);
    }
  }
  [[nodiscard]] SearchRows rows() const {
    return {{values[0], kFeatureStride, begins[0]},
            {values[1], kWindowFloats, begins[1]},
            {values[2], kWholeFloats, begins[2]}};
  }
};

std::vector<float> query_part(const std::vector<float>& rows, int first, int count) {
  return {rows.begin() + 64 * first, rows.begin() + 64 * (first + count)};
}

// Clips of 8 to 87 rows.
MadeLibrary made_library(int count) {
  MadeLibrary made;
  for (int k = 0; k < count; ++k) {
    made.add(random_rows(static_cast<std::uint64_t>(k) + 1, 8 + (k * 37) % 80));
  }
  return made;
}

// All clips, each compared without a bound, sorted.
std::vector<SimilarMotion> plain_search(const std::vector<float>& query,
                                        const MadeLibrary& made,
                                        WarpEnds ends) {
  std::vector<SimilarMotion> all;
  for (std::size_t k = 0; k < made.clips.size(); ++k) {
    WarpScratch scratch;
    const auto match = warp_distance(query, made.clips[k], ends, scratch);
    if (!match) continue;
    all.push_back(
        {static_cast<int>(k), match->first_row, match->last_row, match->distance});
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.distance < b.distance;
  });
  all.resize(std::min<std::size_t>(all.size(), 10));
  return all;
}

void expect_same(const std::vector<SimilarMotion>& a,
                 const std::vector<SimilarMotion>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].clip, b[k].clip);
    EXPECT_EQ(a[k].first_row, b[k].first_row);
    EXPECT_EQ(a[k].last_row, b[k].last_row);
    EXPECT_EQ(a[k].distance, b[k].distance);
  }
}

TEST(FindSimilar, ExactIsTheSearchOfAllClips) {
  const MadeLibrary made = made_library(60);
  for (const int length : {5, 21, 30, 50}) {
    const std::vector<float> query = random_rows(999, length);
    for (const bool whole : {false, true}) {
      FindSimilarOptions options;
      options.exact = true;
      options.whole_clips = whole;
      expect_same(
          find_similar(query, made.rows(), options),
          plain_search(query, made, whole ? WarpEnds::kWhole : WarpEnds::kSubsequence));
    }
  }
}

TEST(FindSimilar, WithAllClipsAsCandidatesIsExact) {
  const MadeLibrary made = made_library(60);
  const std::vector<float> query = random_rows(77, 21);
  FindSimilarOptions options;
  options.candidates = 60;
  expect_same(find_similar(query, made.rows(), options),
              plain_search(query, made, WarpEnds::kSubsequence));
}

TEST(FindSimilar, FindsThePartOfAClipThatIsTheQuery) {
  const MadeLibrary made = made_library(60);
  int asked = 0;
  for (std::size_t clip = 0; clip < made.clips.size(); ++clip) {
    if (made.clips[clip].size() < 24 * 64) continue;
    ++asked;
    const std::vector<float> query = query_part(made.clips[clip], 2, 21);
    const auto found = find_similar(query, made.rows());
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].clip, static_cast<int>(clip));
    EXPECT_EQ(found[0].first_row, 2);
    EXPECT_EQ(found[0].last_row, 22);
    EXPECT_EQ(found[0].distance, 0.0);
    FindSimilarOptions options;
    options.skipped_clip = static_cast<int>(clip);
    for (const SimilarMotion& other : find_similar(query, made.rows(), options)) {
      EXPECT_NE(other.clip, static_cast<int>(clip));
    }
  }
  EXPECT_GT(asked, 20);
}

TEST(FindSimilar, FindsTheMirrorImage) {
  MadeLibrary made = made_library(30);
  const std::vector<float> left = random_rows(555, 40);
  made.add(mirrored_features(left));
  FindSimilarOptions options;
  options.mirror = true;
  for (const bool whole : {false, true}) {
    options.whole_clips = whole;
    const auto found = find_similar(left, made.rows(), options);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].clip, 30);
    EXPECT_EQ(found[0].distance, 0.0);
  }
  options.mirror = false;
  const auto plain = find_similar(left, made.rows(), options);
  EXPECT_TRUE(plain.empty() || plain[0].distance > 0.01);
}

TEST(FindSimilar, UsesTheMiddleOfALongerQuery) {
  const MadeLibrary made = made_library(30);
  const std::vector<float> query = random_rows(600, 60);
  FindSimilarOptions options;
  options.length_s = 2.0;
  expect_same(find_similar(query, made.rows(), options),
              find_similar(query_part(query, 19, 21), made.rows()));
  options.length_s = 100.0;
  expect_same(find_similar(query, made.rows(), options),
              find_similar(query, made.rows()));
}

TEST(FindSimilar, OrdersEqualClipsByTheirNumber) {
  MadeLibrary made;
  const std::vector<float> rows = random_rows(1, 40);
  for (int k = 0; k < 30; ++k) made.add(rows);
  for (const bool exact : {false, true}) {
    FindSimilarOptions options;
    options.exact = exact;
    options.candidates = 15;
    const auto found = find_similar(query_part(rows, 6, 21), made.rows(), options);
    ASSERT_EQ(found.size(), 10U);
    for (int k = 0; k < 10; ++k) EXPECT_EQ(found[static_cast<std::size_t>(k)].clip, k);
  }
}

TEST(FindSimilar, AcceptsEmptyLibrariesAndQueries) {
  const MadeLibrary empty;
  const MadeLibrary made = made_library(5);
  EXPECT_TRUE(find_similar(random_rows(1, 21), empty.rows()).empty());
  EXPECT_TRUE(find_similar({}, made.rows()).empty());
  FindSimilarOptions options;
  options.top = 0;
  EXPECT_TRUE(find_similar(random_rows(1, 21), made.rows(), options).empty());
  // One instant is compared with every instant of every clip.
  const auto found = find_similar(query_part(made.clips[3], 4, 1), made.rows());
  ASSERT_EQ(found.size(), 5U);
  EXPECT_EQ(found[0].clip, 3);
  EXPECT_EQ(found[0].first_row, 4);
  options.top = 10;
  options.skipped_clip = 3;
  const auto others = find_similar(query_part(made.clips[3], 4, 1), made.rows(), options);
  ASSERT_EQ(others.size(), 4U);
  for (const SimilarMotion& other : others) EXPECT_NE(other.clip, 3);
}

}  // namespace
}  // namespace marey::library
