// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/markers/filter_markers.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/edit/markers/marker_scene.h"

namespace marey::edit {
namespace {

constexpr double kNoise_m = 0.002;

MarkerState noisy_state(std::uint64_t seed) {
  MarkerTracks tracks = made_tracks();
  add_marker_noise(tracks, seed, kNoise_m);
  return *make_marker_state(std::move(tracks));
}

FilterOp butterworth(CutoffRule rule, double cutoff_hz = 0.0) {
  FilterOp op;
  op.method = FilterMethod::kButterworth;
  op.cutoff = rule;
  op.cutoff_hz = cutoff_hz;
  return op;
}

TEST(FilterMarkers, HalvesTheErrorOfWhiteNoise) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const MarkerState state = noisy_state(seed);
    MarkerScene scene{FilterOp{}};
    const auto out = scene.run(state);
    ASSERT_TRUE(out) << out.error().message();
    for (std::size_t m = 0; m < state.tracks.markers(); ++m) {
      EXPECT_LT(made_error_m(out->tracks, m), 0.6 * made_error_m(state.tracks, m))
          << "seed " << seed << ", " << state.tracks.labels[m];
    }
  }
}

TEST(FilterMarkers, EstimatesTheNoisePerCoordinate) {
  const MarkerState state = noisy_state(11);
  MarkerScene scene{FilterOp{}};
  ASSERT_TRUE(scene.run(state));
  for (const std::string& label : state.tracks.labels) {
    EXPECT_NEAR(scene.figure(label + "_noise_mm"), 1e3 * kNoise_m, 0.3) << label;
    EXPECT_GT(scene.figure(label + "_cutoff_hz"), 3.0) << label;
    EXPECT_LT(scene.figure(label + "_cutoff_hz"), 30.0) << label;
  }
}

TEST(FilterMarkers, LeavesMarkersWithoutNoiseInPlace) {
  const MarkerState state = *make_marker_state(made_tracks());
  MarkerScene scene{FilterOp{}};
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  EXPECT_LT(scene.figure("displaced_mm"), 0.05);
}

TEST(FilterMarkers, KeepsGapsAndFiltersEachPieceApart) {
  MarkerState state = noisy_state(3);
  make_gap(state.tracks, 0, 100, 139);
  MarkerScene scene{FilterOp{}};
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  for (int t = 0; t < 360; ++t) {
    EXPECT_EQ(out->tracks.at(static_cast<std::size_t>(t), 0).has_value(),
              t < 100 || t > 139);
  }
  // A large error in the other piece has no effect on this one, if the filter is given.
  MarkerState disturbed = state;
  for (std::size_t t = 140; t < 360; ++t) disturbed.tracks.at(t, 0)->p_in_world.y += 3.0;
  MarkerScene given{butterworth(CutoffRule::kGiven, 8.0)};
  const auto first = given.run(state);
  const auto second = given.run(disturbed);
  ASSERT_TRUE(first && second);
  for (std::size_t t = 0; t < 100; ++t) {
    EXPECT_NEAR(glm::distance(first->tracks.at(t, 0)->p_in_world,
                              second->tracks.at(t, 0)->p_in_world),
                0.0,
                1e-12);
  }
  EXPECT_LT(made_error_m(out->tracks, 0), 0.6 * made_error_m(state.tracks, 0));
}

TEST(FilterMarkers, LeavesShortPiecesToTheBitAndReportsThem) {
  MarkerState state = noisy_state(4);
  // Pieces of 100, 4 and 236 frames; the second marker has only pieces of 19.
  make_gap(state.tracks, 0, 100, 109);
  make_gap(state.tracks, 0, 114, 123);
  for (int first = 0; first < 360; first += 20) make_gap(state.tracks, 1, first, first);
  MarkerScene scene{FilterOp{}};
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  for (std::size_t t = 110; t < 114; ++t) {
    EXPECT_EQ(out->tracks.at(t, 0)->p_in_world, state.tracks.at(t, 0)->p_in_world);
  }
  for (std::size_t t = 1; t < 360; ++t) {
    if (!state.tracks.at(t, 1)) continue;
    EXPECT_EQ(out->tracks.at(t, 1)->p_in_world, state.tracks.at(t, 1)->p_in_world);
  }
  EXPECT_EQ(scene.figure("left_samples"), 4.0);
  EXPECT_EQ(scene.figure("filtered_markers"), 5.0);
  EXPECT_TRUE(scene.has_finding("short_pieces"));
  EXPECT_TRUE(scene.has_finding("too_short"));
}

TEST(FilterMarkers, ReportsMarkersThatStandStillOrAreNeverSeen) {
  MarkerState state = noisy_state(5);
  make_gap(state.tracks, 2, 0, 359);
  for (std::size_t t = 0; t < 360; ++t) state.tracks.at(t, 3)->p_in_world = {1, 2, 3};
  MarkerScene scene{FilterOp{}};
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  EXPECT_TRUE(scene.has_finding("never_seen"));
  EXPECT_TRUE(scene.has_finding("constant"));
  for (std::size_t t = 0; t < 360; ++t) {
    EXPECT_EQ(out->tracks.at(t, 3)->p_in_world, glm::dvec3(1, 2, 3));
  }
}

TEST(FilterMarkers, LeavesFramesOutsideSpanAndFadesToTheBit) {
  const MarkerState state = noisy_state(6);
  MarkerScene scene{FilterOp{}};
  scene.op.span = {AtFrame{100}, AtFrame{200}};
  scene.op.blend_s = 0.1;
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  bool has_changed = false;
  for (std::size_t t = 0; t < 360; ++t) {
    for (std::size_t m = 0; m < 6; ++m) {
      const glm::dvec3& before = state.tracks.at(t, m)->p_in_world;
      const glm::dvec3& after = out->tracks.at(t, m)->p_in_world;
      EXPECT_TRUE(before == after || (t >= 88 && t <= 212)) << t;
      if (t >= 100 && t <= 200) has_changed |= before != after;
    }
  }
  EXPECT_TRUE(has_changed);
}

TEST(FilterMarkers, DoesNotDependOnPlaceAndHeading) {
  const MarkerState state = noisy_state(7);
  PlaceOp place;
  place.position_xz_m = glm::dvec2(3.0, -2.0);
  place.heading_rad = 0.7;
  MarkerScene filter{FilterOp{}};
  MarkerScene first{place};
  // The place is given by the markers, so the same move is made by hand afterwards.
  const auto placed = first.run(state);
  ASSERT_TRUE(placed) << placed.error().message();
  const auto filtered_later = filter.run(*placed);
  const auto filtered = filter.run(state);
  ASSERT_TRUE(filtered && filtered_later);
  const glm::dvec3 a = state.tracks.at(0, 0)->p_in_world;
  const glm::dvec3 b = placed->tracks.at(0, 0)->p_in_world;
  const double turn_rad = first.figure("turn_deg") / 180.0 * std::numbers::pi;
  for (std::size_t t = 0; t < 360; ++t) {
    const glm::dvec3 d = filtered->tracks.at(t, 4)->p_in_world - a;
    const double c = std::cos(turn_rad);
    const double s = std::sin(turn_rad);
    const glm::dvec3 expected = b + glm::dvec3(c * d.x + s * d.z, d.y, c * d.z - s * d.x);
    EXPECT_LT(glm::distance(expected, filtered_later->tracks.at(t, 4)->p_in_world), 1e-9);
  }
}

TEST(FilterMarkers, ButterworthHasTheGivenCutoff) {
  MarkerState state = *make_marker_state(made_tracks(1200));
  // A pure sine at the cut-off keeps 0.707 of its size.
  constexpr double kCutoff_hz = 6.0;
  for (std::size_t t = 0; t < 1200; ++t) {
    const double phase =
        2.0 * std::numbers::pi * kCutoff_hz * static_cast<double>(t) / 120.0;
    state.tracks.at(t, 0)->p_in_world = {0.0, std::sin(phase), 0.0};
  }
  MarkerScene scene{butterworth(CutoffRule::kGiven, kCutoff_hz)};
  const auto out = scene.run(state);
  ASSERT_TRUE(out);
  double largest = 0.0;
  for (std::size_t t = 300; t < 900; ++t) {
    largest = std::max(largest, std::abs(out->tracks.at(t, 0)->p_in_world.y));
  }
  EXPECT_NEAR(largest, std::sqrt(0.5), 0.01);
  EXPECT_EQ(scene.figure("LASI_cutoff_hz"), kCutoff_hz);
  // Samples that move by more than 10 mm are invented.
  EXPECT_EQ(out->tracks.at(305, 0)->source, Source::kInferred);
  EXPECT_EQ(out->lineage.frames[305].trust, Source::kInferred);
}

TEST(FilterMarkers, ChoosesTheCutoffsOfWinterAndYu) {
  const MarkerState state = noisy_state(8);
  MarkerScene yu{butterworth(CutoffRule::kYu)};
  ASSERT_TRUE(yu.run(state));
  EXPECT_NEAR(yu.figure("C7_cutoff_hz"), 0.071 * 120 - 0.00003 * 120 * 120, 1e-9);
  MarkerScene winter{butterworth(CutoffRule::kWinter)};
  const auto out = winter.run(state);
  ASSERT_TRUE(out);
  for (std::size_t m = 0; m < 6; ++m) {
    EXPECT_LT(made_error_m(out->tracks, m), 0.9 * made_error_m(state.tracks, m));
  }
}

TEST(FilterMarkers, FilledSamplesCountLess) {
  // A third of the samples is wrong by 20 mm; they are marked as filled.
  MarkerState state = noisy_state(9);
  testing::Dice dice(10);
  for (std::size_t t = 0; t < 360; t += 3) {
    state.tracks.at(t, 1)->p_in_world.y += dice.noise(0.02);
  }
  MarkerState marked = state;
  for (std::size_t t = 0; t < 360; t += 3) {
    marked.tracks.at(t, 1)->source = Source::kRepaired;
  }
  MarkerScene scene{FilterOp{}};
  const auto trusted = scene.run(state);
  const auto out = scene.run(marked);
  ASSERT_TRUE(trusted && out);
  EXPECT_LT(made_error_m(out->tracks, 1), 0.9 * made_error_m(trusted->tracks, 1));
}

TEST(FilterMarkers, ReportsAMarkerThatJumps) {
  MarkerState state = noisy_state(12);
  MarkerScene scene{FilterOp{}};
  ASSERT_TRUE(scene.run(state));
  EXPECT_FALSE(scene.has_finding("outlier"));
  state.tracks.at(180, 3)->p_in_world.x += 0.5;
  ASSERT_TRUE(scene.run(state));
  ASSERT_TRUE(scene.has_finding("outlier"));
  const Finding& finding = scene.report.findings.back();
  EXPECT_EQ(finding.where, "RKNE");
  EXPECT_NE(finding.cause.find("at 1.50 s"), std::string::npos) << finding.cause;
}

TEST(FilterMarkers, RefusesGroupsAndWrongCutoffs) {
  const MarkerState state = noisy_state(10);
  MarkerScene groups{FilterOp{}};
  groups.op.groups = {EditGroup::kTrunk};
  const auto first = groups.run(state);
  ASSERT_FALSE(first);
  EXPECT_NE(first.error().message().find("groups"), std::string::npos);
  MarkerScene high{butterworth(CutoffRule::kGiven, 60.0)};
  EXPECT_FALSE(high.run(state));
  FilterOp order;
  order.order = 4;
  MarkerScene fourth{order};
  EXPECT_FALSE(fourth.run(state));
}

}  // namespace
}  // namespace marey::edit
