// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/find_marker_faults.h"

#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_markers.h"

namespace marey::reconstruct {
namespace {

TEST(FindMarkerFaults, ReportsNothingForCorrectTracks) {
  const MarkerTracks tracks = testing::synthetic_markers(400, 0.001);
  const CheckedTracks checked = find_marker_faults(tracks);
  EXPECT_TRUE(checked.findings.empty());
  for (std::size_t i = 0; i < tracks.samples.size(); ++i) {
    EXPECT_EQ(checked.tracks.samples[i]->p_in_world, tracks.samples[i]->p_in_world);
  }
}

TEST(FindMarkerFaults, PutsExchangedMarkersBack) {
  const MarkerTracks truth = testing::synthetic_markers(400, 0.0005);
  MarkerTracks swapped = truth;
  for (std::size_t f = 150; f < 210; ++f) std::swap(swapped.at(f, 2), swapped.at(f, 17));
  const CheckedTracks checked = find_marker_faults(swapped);
  ASSERT_EQ(checked.findings.size(), 1U);
  EXPECT_EQ(checked.findings[0].fault, TrackFault::kExchanged);
  EXPECT_EQ(checked.findings[0].marker, 2U);
  EXPECT_EQ(checked.findings[0].other, 17U);
  EXPECT_EQ(checked.findings[0].first, 150U);
  EXPECT_EQ(checked.findings[0].frames, 60U);
  for (std::size_t f = 0; f < 400; ++f) {
    EXPECT_EQ(checked.tracks.at(f, 2)->p_in_world, truth.at(f, 2)->p_in_world);
    EXPECT_EQ(checked.tracks.at(f, 17)->p_in_world, truth.at(f, 17)->p_in_world);
  }
}

TEST(FindMarkerFaults, TakesAJumpOut) {
  MarkerTracks tracks = testing::synthetic_markers(400, 0.0005);
  for (std::size_t f = 80; f < 100; ++f) {
    tracks.at(f, 11)->p_in_world += glm::dvec3(0.1, 0.0, 0.05);
  }
  const CheckedTracks checked = find_marker_faults(tracks);
  ASSERT_EQ(checked.findings.size(), 1U);
  EXPECT_EQ(checked.findings[0].fault, TrackFault::kJump);
  EXPECT_EQ(checked.findings[0].marker, 11U);
  EXPECT_EQ(checked.findings[0].first, 80U);
  EXPECT_EQ(checked.findings[0].frames, 20U);
  EXPECT_TRUE(checked.tracks.at(79, 11));
  EXPECT_FALSE(checked.tracks.at(80, 11));
  EXPECT_FALSE(checked.tracks.at(99, 11));
  EXPECT_TRUE(checked.tracks.at(100, 11));
}

TEST(FindMarkerFaults, TakesAGhostOut) {
  MarkerTracks tracks = testing::synthetic_markers(400, 0.0005);
  for (std::size_t f = 100; f < 200; ++f) tracks.at(f, 8).reset();
  for (std::size_t f = 140; f < 150; ++f) {
    MarkerSample ghost;
    ghost.p_in_world = tracks.at(f, 20)->p_in_world + glm::dvec3(0.0, 0.3, 0.0);
    tracks.at(f, 8) = ghost;
  }
  const CheckedTracks checked = find_marker_faults(tracks);
  ASSERT_EQ(checked.findings.size(), 1U);
  EXPECT_EQ(checked.findings[0].fault, TrackFault::kGhost);
  EXPECT_EQ(checked.findings[0].first, 140U);
  EXPECT_EQ(checked.findings[0].frames, 10U);
  EXPECT_FALSE(checked.tracks.at(145, 8));
}

TEST(FindMarkerFaults, RemovesFrozenSamples) {
  MarkerTracks tracks = testing::synthetic_markers(400, 0.0005);
  for (std::size_t f = 121; f < 160; ++f) tracks.at(f, 6) = tracks.at(120, 6);
  const CheckedTracks checked = find_marker_faults(tracks);
  ASSERT_EQ(checked.findings.size(), 1U);
  EXPECT_EQ(checked.findings[0].fault, TrackFault::kFrozen);
  EXPECT_EQ(checked.findings[0].first, 121U);
  EXPECT_EQ(checked.findings[0].frames, 39U);
  EXPECT_TRUE(checked.tracks.at(120, 6));
  EXPECT_FALSE(checked.tracks.at(121, 6));
}

TEST(FindMarkerFaults, ReportsNoFrozenMarkersForAStillBody) {
  MarkerTracks tracks = testing::synthetic_markers(1, 0.0005);
  const auto first = tracks.samples;
  for (int f = 0; f < 99; ++f) {
    tracks.samples.insert(tracks.samples.end(), first.begin(), first.end());
  }
  EXPECT_TRUE(find_marker_faults(tracks).findings.empty());
}

TEST(FindMarkerFaults, NonFiniteNumbersAreRemoved) {
  MarkerTracks tracks = testing::synthetic_markers(50);
  tracks.at(7, 3)->p_in_world.x = std::numeric_limits<double>::quiet_NaN();
  tracks.at(8, 3)->p_in_world.y = 1e30;
  const CheckedTracks checked = find_marker_faults(tracks);
  ASSERT_EQ(checked.findings.size(), 1U);
  EXPECT_EQ(checked.findings[0].fault, TrackFault::kNoNumber);
  EXPECT_EQ(checked.findings[0].first, 7U);
  EXPECT_EQ(checked.findings[0].frames, 2U);
}

}  // namespace
}  // namespace marey::reconstruct
