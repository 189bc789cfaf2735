// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/features/feature_basis.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/library/moved_motion.h"

namespace marey::library {
namespace {

double squared(std::span<const float> a, std::span<const float> b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double d = static_cast<double>(a[k]) - b[k];
    sum += d * d;
  }
  return sum;
}

TEST(FeatureBasis, IsOrthonormal) {
  const FeatureBasis& basis = feature_basis();
  for (std::size_t a = 0; a < kBasisCount; ++a) {
    for (std::size_t b = 0; b < kBasisCount; ++b) {
      double sum = 0.0;
      for (std::size_t c = 0; c < kFeatureCount; ++c) {
        sum += static_cast<double>(basis[a][c]) * basis[b][c];
      }
      EXPECT_NEAR(sum, a == b ? 1.0 : 0.0, 2e-6);
    }
  }
}

// The space of the basis contains the mirror image of each of its members.
TEST(FeatureBasis, TreatsBothSidesAlike) {
  const std::vector<float> rows = random_rows(1, 50);
  const std::vector<float> mirrored = mirrored_features(rows);
  for (std::size_t k = 0; k < rows.size(); k += kFeatureStride) {
    const auto a = project_features(std::span(rows).subspan(k, kFeatureCount));
    const auto b = project_features(std::span(mirrored).subspan(k, kFeatureCount));
    const std::array<float, kBasisCount> zero{};
    EXPECT_NEAR(squared(a, zero), squared(b, zero), 1e-4);
  }
}

TEST(FeatureBasis, NeverLengthensADistance) {
  const std::vector<float> rows = random_rows(2, 60);
  for (std::size_t k = kFeatureStride; k < rows.size(); k += kFeatureStride) {
    const auto a = std::span(rows).subspan(0, kFeatureCount);
    const auto b = std::span(rows).subspan(k, kFeatureCount);
    EXPECT_LE(squared(project_features(a), project_features(b)),
              squared(a, b) * (1.0 + 1e-5));
  }
}

TEST(FeatureWindows, AreTheirKeyInstants) {
  const std::vector<float> rows = random_rows(3, 47);
  const std::vector<float> windows = feature_windows(rows);
  ASSERT_EQ(window_count(47), 9);
  ASSERT_EQ(windows.size(), 9U * kWindowFloats);
  // Rows floor((k + 1/2) 21 / 4).
  constexpr std::size_t kKeys[] = {2, 7, 13, 18};
  for (std::size_t w = 0; w < 9; ++w) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto key = project_features(
          std::span(rows).subspan((3 * w + kKeys[k]) * kFeatureStride, kFeatureCount));
      for (std::size_t d = 0; d < kBasisCount; ++d) {
        EXPECT_EQ(windows[w * kWindowFloats + k * kBasisCount + d], key[d]);
      }
    }
  }
}

TEST(FeatureWindows, AreCountedForClipsOfAnyLength) {
  EXPECT_EQ(window_count(0), 0);
  EXPECT_EQ(window_count(1), 1);
  EXPECT_EQ(window_count(20), 1);
  EXPECT_EQ(window_count(21), 1);
  EXPECT_EQ(window_count(23), 1);
  EXPECT_EQ(window_count(24), 2);
  for (int rows = 0; rows < 30; ++rows) {
    const std::vector<float> clip = random_rows(4, rows);
    EXPECT_EQ(feature_windows(clip).size(),
              static_cast<std::size_t>(window_count(rows)) * kWindowFloats);
    EXPECT_EQ(whole_clip_row(clip).size(), rows == 0 ? 0U : kWholeFloats);
  }
}

TEST(FeatureWindows, RepeatASingleInstant) {
  const std::vector<float> clip = random_rows(5, 1);
  const auto key = project_features(clip);
  const std::vector<float> whole = whole_clip_row(clip);
  for (std::size_t k = 0; k < kWholeFloats; ++k)
    EXPECT_EQ(whole[k], key[k % kBasisCount]);
}

}  // namespace
}  // namespace marey::library
