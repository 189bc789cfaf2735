// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/features/feature_span.h"

#include <random>
#include <vector>

#include "library/features/body_features.h"
#include <gtest/gtest.h>

#include "retarget/body/body_map.h"
#include "tests/library/moved_motion.h"

namespace marey::library {
namespace {

TEST(FeatureSpan, CountsTheRowsOfEveryMotion) {
  std::mt19937 random(3);
  for (const double hz : {10.0, 24.0, 29.97, 30.0, 59.94, 60.0, 100.0, 120.0, 240.0}) {
    for (int i = 0; i < 20; ++i) {
      Motion motion = random_motion(1, 1 + static_cast<int>(random() % 90), hz);
      motion.first_frame = static_cast<int>(random() % 1000);
      const auto map = retarget::map_body(motion.skeleton);
      ASSERT_TRUE(map);
      const BodyFeatures features = body_features(motion, *map);
      const int last = motion.first_frame + static_cast<int>(motion.poses.size()) - 1;
      const FeatureSpan span = feature_span(motion.first_frame, last, hz);
      EXPECT_EQ(span.count, features.count()) << hz;
      EXPECT_NEAR(span.start_s, features.start_s, 1e-9);
    }
  }
}

TEST(FeatureSpan, PartsHaveTheRowsOfTheWhole) {
  const FeatureSpan whole = feature_span(100, 399, 30.0);
  const auto rows = random_rows(5, whole.count);
  std::mt19937 random(4);
  for (int i = 0; i < 200; ++i) {
    const int first = 100 + static_cast<int>(random() % 300);
    const int last =
        first + static_cast<int>(random() % (400U - static_cast<unsigned>(first)));
    const FeatureSpan part = feature_span(first, last, 30.0);
    const auto cut = rows_of_part(rows, whole, part);
    ASSERT_EQ(cut.size(), static_cast<std::size_t>(part.count) * kFeatureStride);
    EXPECT_GE(part.start_s, 0.0);
    EXPECT_LE(part.start_s, 0.1);
  }
  const auto all = rows_of_part(rows, whole, whole);
  EXPECT_EQ(all.data(), rows.data());
  EXPECT_EQ(all.size(), rows.size());
}

}  // namespace
}  // namespace marey::library
