// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/marker_tracks.h"
#include "reconstruct/labels/name_markers.h"
#include "reconstruct/markers/fit_markers.h"
#include "reconstruct/markers/solve_markers.h"
#include "recordings/markers/marker_file.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/contact_edges.h"
#include "tests/support/program/paths.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

/// Fits a person to all markers of the files and solves the first one.
std::optional<Motion> fitted_motion(const std::vector<fs::path>& files) {
  std::vector<MarkerTracks> trials;
  for (const fs::path& file : files) {
    auto read = recordings::read_markers(file);
    if (!read) return std::nullopt;
    trials.push_back(std::move(read->tracks));
  }
  const auto names = reconstruct::name_markers(trials[0].labels);
  std::vector<reconstruct::NamedMarker> labels;
  for (std::size_t i = 0; i < trials[0].labels.size(); ++i) {
    labels.push_back({trials[0].labels[i], names.landmarks[i]});
  }
  const auto fit = reconstruct::fit_markers({}, trials, labels);
  if (!fit) return std::nullopt;
  auto solved = reconstruct::solve_markers(fit->body, trials[0]);
  if (!solved) return std::nullopt;
  return std::move(solved->estimate.motion);
}

// A drop jump between two plates at 2 kHz. Times at which the vertical force of each foot
// passes 20 N, left and right: landing, take-off. The second landing is not judged: the
// recording ends 0.1 s after it. Markers at 100 Hz.
TEST(PlateEdges, AreFoundInADropJumpWithinAFrame) {
  const fs::path folder =
      testing::shared_data() / "mocap" / "nimblephysics" / "osim" / "LaiArnoldSubject5";
  if (!fs::exists(folder / "DJ1.trc")) GTEST_SKIP() << "the recording is not there";
  const auto motion = fitted_motion({folder / "DJ1.trc", folder / "DJ2.trc"});
  ASSERT_TRUE(motion);
  const auto map = retarget::map_body(motion->skeleton);
  ASSERT_TRUE(map);
  const auto edges = retarget::find_contact_edges(*motion, *map);
  constexpr std::array<double, 2> kLanding_s{1.4924, 1.4969};
  constexpr std::array<double, 2> kTakeoff_s{2.2590, 2.2600};
  constexpr double kFrame_s = 0.01;
  for (std::size_t side = 0; side < 2; ++side) {
    ASSERT_FALSE(edges.feet[side].empty());
    const retarget::StanceEdges& stance = edges.feet[side].front();
    ASSERT_TRUE(stance.strike);
    EXPECT_NEAR(stance.strike->time_s, kLanding_s[side], kFrame_s);
    EXPECT_EQ(stance.strike->rule, retarget::EdgeRule::kHeight);
    ASSERT_TRUE(stance.toe_off);
    EXPECT_NEAR(stance.toe_off->time_s, kTakeoff_s[side], kFrame_s);
  }
}

struct PlateStrike {
  std::size_t side = 0;
  double time_s = 0.0;
};

void expect_strikes(const std::vector<fs::path>& files,
                    const std::vector<PlateStrike>& strikes,
                    double within_s) {
  const auto motion = fitted_motion(files);
  ASSERT_TRUE(motion);
  const auto map = retarget::map_body(motion->skeleton);
  ASSERT_TRUE(map);
  const auto edges = retarget::find_contact_edges(*motion, *map);
  for (const PlateStrike& strike : strikes) {
    double nearest_s = 1.0;
    for (const auto& stance : edges.feet[strike.side]) {
      if (!stance.strike) continue;
      const double off_s = std::abs(stance.strike->time_s - strike.time_s);
      if (off_s > nearest_s) continue;
      nearest_s = off_s;
      EXPECT_TRUE(off_s > within_s || stance.strike->rule == retarget::EdgeRule::kArrest);
    }
    EXPECT_LT(nearest_s, within_s) << strike.time_s << " s";
  }
}

// Three people. Times at which the vertical force passes 20 N.
// Markers at 100, 200 and 240 Hz.
TEST(PlateEdges, AreFoundInWalksWithin12ms) {
  const fs::path mocap = testing::shared_data() / "mocap";
  const fs::path shoes = mocap / "opensim-models" / "Rajagopal" / "ExpData";
  if (!fs::exists(shoes)) GTEST_SKIP() << "the recordings are not there";
  constexpr double kWithin_s = 0.012;
  expect_strikes({shoes / "motion_capture_walk.trc", shoes / "static_walk_1.trc"},
                 {{1, 0.2675}, {0, 0.8363}, {1, 1.4120}},
                 kWithin_s);
  expect_strikes(
      {mocap / "ezc3d" / "Qualisys.c3d"}, {{0, 0.0744}, {1, 0.5378}}, kWithin_s);
  expect_strikes({mocap / "c3d_org_samples" / "sample_26" / "Walking_Hybrid_1_1.c3d"},
                 {{1, 0.6519}, {0, 1.1687}},
                 kWithin_s);
}

}  // namespace
}  // namespace marey
