// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/marker_tracks.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

MarkerTracks two_markers() {
  MarkerTracks tracks;
  tracks.labels = {"heel", "toe"};
  tracks.rate = FrameRate{100.0};
  tracks.first_frame = 31;
  tracks.start_s = 0.3;
  tracks.samples.resize(6);
  return tracks;
}

// A gap is no place, not a place with a sign that it is none.
TEST(MarkerTracks, HoldGapsApartFromPlaces) {
  MarkerTracks tracks = two_markers();
  tracks.at(0, 1) = MarkerSample{{0.1, 0.0, 0.2}, 0.002F, 3, Source::kMeasured};
  tracks.at(2, 1) = MarkerSample{};
  EXPECT_TRUE(tracks.at(0, 1).has_value());
  EXPECT_FALSE(tracks.at(1, 1).has_value());
  EXPECT_TRUE(tracks.at(2, 1).has_value());
  EXPECT_FALSE(tracks.at(2, 0).has_value());
}

TEST(MarkerTracks, AreLaidOutFrameByFrame) {
  MarkerTracks tracks = two_markers();
  tracks.at(1, 0) = MarkerSample{{0.1, 0.0, 0.3}, 0.020F, 0, Source::kRepaired};
  EXPECT_EQ(tracks.frames(), 3U);
  EXPECT_EQ(tracks.markers(), 2U);
  ASSERT_TRUE(tracks.samples[2].has_value());
  EXPECT_EQ(name(tracks.samples[2]->source), "repaired");
  EXPECT_DOUBLE_EQ(tracks.time_s(2), 0.32);
}

TEST(MarkerTracks, WithoutMarkersHaveNoFrames) {
  EXPECT_EQ(MarkerTracks{}.frames(), 0U);
}

}  // namespace
}  // namespace marey
