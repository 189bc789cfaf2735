// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/repair_gaps.h"

#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_markers.h"

namespace marey::reconstruct {
namespace {

void cut(MarkerTracks& tracks,
         std::size_t marker,
         std::size_t first,
         std::size_t frames) {
  for (std::size_t f = first; f < first + frames; ++f) tracks.at(f, marker).reset();
}

double worst_error_m(const MarkerTracks& truth,
                     const MarkerTracks& repaired,
                     std::size_t marker,
                     std::size_t first,
                     std::size_t frames) {
  double worst_m = 0.0;
  for (std::size_t f = first; f < first + frames; ++f) {
    if (!repaired.at(f, marker)) return 1e9;
    worst_m = std::max(worst_m,
                       glm::distance(truth.at(f, marker)->p_in_world,
                                     repaired.at(f, marker)->p_in_world));
  }
  return worst_m;
}

TEST(RepairGaps, AMarkerOfARigidPartIsWhereThePartHasIt) {
  const MarkerTracks truth = testing::synthetic_markers(400);
  MarkerTracks holed = truth;
  cut(holed, 12, 100, 150);
  const RepairedTracks repaired = repair_gaps(holed);
  EXPECT_LT(worst_error_m(truth, repaired.tracks, 12, 100, 150), 0.0005);
  ASSERT_EQ(repaired.gaps.size(), 1U);
  EXPECT_EQ(repaired.gaps[0].marker, 12U);
  EXPECT_EQ(repaired.gaps[0].first, 100U);
  EXPECT_EQ(repaired.gaps[0].frames, 150U);
  EXPECT_EQ(repaired.gaps[0].method, RepairMethod::kCluster);
  // The four markers on its own part carry it.
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(repaired.gaps[0].carried_by[i] / 5, 2U);
  EXPECT_EQ(repaired.tracks.at(120, 12)->source, Source::kRepaired);
}

TEST(RepairGaps, SamplesThatAreThereStayAsTheyAre) {
  const MarkerTracks truth = testing::synthetic_markers(200, 0.0005);
  MarkerTracks holed = truth;
  cut(holed, 3, 50, 60);
  const RepairedTracks repaired = repair_gaps(holed);
  for (std::size_t i = 0; i < truth.samples.size(); ++i) {
    if (!holed.samples[i]) continue;
    EXPECT_EQ(repaired.tracks.samples[i]->p_in_world, truth.samples[i]->p_in_world);
    EXPECT_EQ(repaired.tracks.samples[i]->source, Source::kMeasured);
  }
}

TEST(RepairGaps, SigmasHoldUnderNoise) {
  const MarkerTracks clean = testing::synthetic_markers(500);
  MarkerTracks holed = testing::synthetic_markers(500, 0.001);
  for (std::size_t m = 0; m < holed.markers(); ++m) cut(holed, m, 20 + 17 * m, 40);
  const RepairedTracks repaired = repair_gaps(holed);
  int within = 0;
  int samples = 0;
  for (std::size_t m = 0; m < holed.markers(); ++m) {
    for (std::size_t f = 20 + 17 * m; f < 60 + 17 * m; ++f) {
      const auto& found = repaired.tracks.at(f, m);
      ASSERT_TRUE(found);
      const double off = glm::distance(found->p_in_world, clean.at(f, m)->p_in_world) /
                         static_cast<double>(found->sigma_m);
      within += off * off < 7.815 ? 1 : 0;  // 95 % of chi square, three degrees
      ++samples;
    }
  }
  EXPECT_GT(within, 0.9 * samples);
}

TEST(RepairGaps, AGapMeetsItsEdges) {
  const MarkerTracks truth = testing::synthetic_markers(400, 0.0003);
  MarkerTracks holed = truth;
  // The whole lower limb except one marker: the remaining ones carry little information
  // on its place.
  for (std::size_t m = 10; m < 14; ++m) cut(holed, m, 200, 80);
  const RepairedTracks repaired = repair_gaps(holed);
  for (std::size_t m = 10; m < 14; ++m) {
    EXPECT_LT(worst_error_m(truth, repaired.tracks, m, 200, 1), 0.004);
    EXPECT_LT(worst_error_m(truth, repaired.tracks, m, 279, 1), 0.004);
    EXPECT_GT(repaired.tracks.at(240, m)->sigma_m, repaired.tracks.at(200, m)->sigma_m);
  }
}

TEST(RepairGaps, BeforeTheFirstSightItIsInferred) {
  const MarkerTracks truth = testing::synthetic_markers(300);
  MarkerTracks holed = truth;
  cut(holed, 7, 0, 50);
  const RepairedTracks repaired = repair_gaps(holed);
  EXPECT_LT(worst_error_m(truth, repaired.tracks, 7, 0, 50), 0.001);
  EXPECT_EQ(repaired.tracks.at(10, 7)->source, Source::kInferred);
}

TEST(RepairGaps, LeavesUnknownGapsEmpty) {
  MarkerTracks holed = testing::synthetic_markers(200);
  cut(holed, 4, 0, 200);  // never seen
  // From frame 100 on only one marker is seen.
  for (std::size_t m = 1; m < holed.markers(); ++m) cut(holed, m, 100, 80);
  const RepairedTracks repaired = repair_gaps(holed);
  for (const GapRepair& gap : repaired.gaps) {
    EXPECT_EQ(gap.method, RepairMethod::kLeftEmpty) << gap.marker;
    EXPECT_TRUE(gap.carried_by.empty());
  }
  EXPECT_FALSE(repaired.tracks.at(50, 4));
  EXPECT_FALSE(repaired.tracks.at(140, 9));
  EXPECT_TRUE(repaired.tracks.at(99, 9));
}

TEST(RepairGaps, AloneAShortGapIsBridgedByTheMarkersOwnPath) {
  const MarkerTracks whole = testing::synthetic_markers(200);
  MarkerTracks alone;
  alone.labels = {"M0"};
  alone.rate = whole.rate;
  for (std::size_t f = 0; f < 200; ++f) alone.samples.push_back(whole.at(f, 0));
  const MarkerTracks truth = alone;
  cut(alone, 0, 80, 10);
  cut(alone, 0, 120, 40);
  const RepairedTracks repaired = repair_gaps(alone);
  ASSERT_EQ(repaired.gaps.size(), 2U);
  EXPECT_EQ(repaired.gaps[0].method, RepairMethod::kSpline);
  EXPECT_LT(worst_error_m(truth, repaired.tracks, 0, 80, 10), 0.002);
  EXPECT_EQ(repaired.gaps[1].method, RepairMethod::kLeftEmpty);
}

TEST(RepairGaps, IsTheSameWhateverTheThreads) {
  MarkerTracks holed = testing::synthetic_markers(300, 0.001);
  for (std::size_t m = 0; m < holed.markers(); m += 2) cut(holed, m, 30 + 8 * m, 45);
  RepairOptions options;
  options.threads = 1;
  const RepairedTracks one = repair_gaps(holed, options);
  options.threads = 3;
  const RepairedTracks three = repair_gaps(holed, options);
  for (std::size_t i = 0; i < holed.samples.size(); ++i) {
    ASSERT_EQ(one.tracks.samples[i].has_value(), three.tracks.samples[i].has_value());
    if (!one.tracks.samples[i]) continue;
    EXPECT_EQ(one.tracks.samples[i]->p_in_world, three.tracks.samples[i]->p_in_world);
    EXPECT_EQ(one.tracks.samples[i]->sigma_m, three.tracks.samples[i]->sigma_m);
  }
}

TEST(RepairGaps, NothingIsRepairedWhereNothingIsMissing) {
  EXPECT_TRUE(repair_gaps(testing::synthetic_markers(30)).gaps.empty());
  MarkerTracks nobody;
  nobody.rate.hz = 100.0;
  EXPECT_TRUE(repair_gaps(nobody).gaps.empty());
}

}  // namespace
}  // namespace marey::reconstruct
