// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/point_track.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

// A gap is no place, not a place with a sign that it is none.
TEST(PointTrack, HoldsGapsApartFromPlaces) {
  PointTrack track{"heel", FrameRate{100.0}, {}};
  track.samples.resize(3);
  track.samples[0] = PointSample{{0.1, 0.0, 0.2}, 0.002, 3, Source::kMeasured};
  track.samples[2] = PointSample{};
  EXPECT_TRUE(track.samples[0].has_value());
  EXPECT_FALSE(track.samples[1].has_value());
  EXPECT_TRUE(track.samples[2].has_value());
}

TEST(PointTrack, KeepsTheDoubtAndTheOriginOfEverySample) {
  PointTrack track{"heel", FrameRate{100.0}, {}};
  track.samples.emplace_back(PointSample{{0.1, 0.0, 0.2}, 0.002, 3, Source::kMeasured});
  track.samples.emplace_back(PointSample{{0.1, 0.0, 0.3}, 0.020, 0, Source::kRepaired});
  const PointTrack copy = track;
  ASSERT_EQ(copy.samples.size(), 2U);
  EXPECT_EQ(copy.samples[0]->views, 3);
  EXPECT_EQ(copy.samples[0]->source, Source::kMeasured);
  EXPECT_EQ(copy.samples[1]->sigma_m, 0.020);
  EXPECT_EQ(name(copy.samples[1]->source), "repaired");
}

}  // namespace
}  // namespace marey
