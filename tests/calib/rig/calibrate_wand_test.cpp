// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/calibrate_wand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::names_of;
using marey::testing::ring_of_cameras;

constexpr double kWandTag_m = 0.16;
constexpr double kWandHalfTurn_rad = std::numbers::pi;

const Wand kWand{{{TagId{0}, kWandTag_m},
                  {TagId{1}, kWandTag_m},
                  {TagId{2}, kWandTag_m},
                  {TagId{3}, kWandTag_m}}};

/// A tag on each side of a box, its printed face outwards.
RigidTransform wand_from_tag(int side) {
  const glm::dquat turn =
      rotation_from_vector({0.0, 0.5 * kWandHalfTurn_rad * side, 0.0});
  return {turn, turn * glm::dvec3(0.0, 0.0, -0.1)};
}

RigidTransform world_from_wand(double share) {
  const double round = 2.0 * kWandHalfTurn_rad * share;
  return {rotation_from_vector({0.0, 2.3 * round, 0.0}) *
              rotation_from_vector({0.6 * std::sin(5.0 * round), 0.0, 0.0}) *
              rotation_from_vector({0.0, 0.0, 0.6 * std::cos(4.0 * round)}),
          {0.7 * std::sin(3.0 * round),
           1.0 + 0.5 * std::cos(2.0 * round),
           0.7 * std::cos(round)}};
}

/// Camera c takes its frames `late[c]` frames after the first; by default, all are
/// simultaneous.
std::vector<CameraDetections> wave_wand(const std::vector<Camera>& cameras,
                                        int frames,
                                        double noise_px,
                                        const std::vector<double>& late = {}) {
  auto out = marey::testing::unseeing(cameras, frames, 10.0, "wand");
  marey::testing::Dice dice(5);
  for (int f = 0; f < frames; ++f) {
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const double at = f + (late.empty() ? 0.0 : late[c]);
      for (int side = 0; side < 4; ++side) {
        const auto tag = marey::testing::see_tag(
            cameras[c],
            world_from_wand(at / static_cast<double>(frames)) * wand_from_tag(side),
            TagId{side},
            kWandTag_m);
        if (!tag) continue;
        out[c].frames[static_cast<std::size_t>(f)].tags.push_back(
            marey::testing::disturbed(*tag, {noise_px, {}, 0.0}, dice));
      }
    }
  }
  return out;
}

/// Distances between cameras do not depend on the world's frame.
double worst_position_m(const CalibratedRig& rig, const std::vector<Camera>& truth) {
  double worst = 0.0;
  for (std::size_t a = 0; a < truth.size(); ++a) {
    for (std::size_t b = a + 1; b < truth.size(); ++b) {
      const double found =
          glm::distance(centre_in_world(rig.cameras[a]), centre_in_world(rig.cameras[b]));
      const double expected =
          glm::distance(centre_in_world(truth[a]), centre_in_world(truth[b]));
      worst = std::max(worst, std::abs(found - expected));
    }
  }
  return worst;
}

TEST(CalibrateWand, RecoversCamerasAndLayoutFromExactCorners) {
  const auto cameras = ring_of_cameras();
  const auto found =
      calibrate_wand(names_of(cameras), wave_wand(cameras, 60, 0.0), kWand);
  ASSERT_TRUE(found) << found.error().message();
  // Priors (a centred principal point, mild distortion) have a small effect.
  EXPECT_LT(worst_position_m(found->rig, cameras), 2e-3);
  ASSERT_EQ(found->wand_from_tag.size(), 4U);
  for (int side = 0; side < 4; ++side) {
    const RigidTransform expected = inverse(wand_from_tag(0)) * wand_from_tag(side);
    EXPECT_LT(glm::distance(found->wand_from_tag.at(TagId{side}).translation,
                            expected.translation),
              2e-4);
  }
}

TEST(CalibrateWand, StaysNearUnderNoise) {
  const auto cameras = ring_of_cameras();
  const auto found =
      calibrate_wand(names_of(cameras), wave_wand(cameras, 60, 0.2), kWand);
  ASSERT_TRUE(found) << found.error().message();
  // A few hundred tags of 45 px: a fifth of a pixel is half a percent of each.
  EXPECT_LT(worst_position_m(found->rig, cameras), 0.03);
  EXPECT_NEAR(found->rig.inlier_rms_px, 0.28, 0.05);
}

// A solution of a long recording takes minutes: its iterations report progress.
TEST(CalibrateWand, ReportsProgressWithinASolution) {
  const auto cameras = ring_of_cameras();
  std::vector<int> reports;
  int total = 0;
  WandOptions options;
  options.progress = [&](int done, int all) {
    reports.push_back(done);
    total = all;
  };
  const auto found =
      calibrate_wand(names_of(cameras), wave_wand(cameras, 60, 0.2), kWand, options);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  EXPECT_EQ(reports.back(), total);
  // Progress is reported before half of the work, which is the solution, is done.
  const auto during = std::count_if(reports.begin(), reports.end(), [&](int done) {
    return done > 0 && 2 * done < total;
  });
  EXPECT_GE(during, 3);
}

// Ten frames a second: half a second and more between neighbours.
TEST(CalibrateWand, FindsOutThatCamerasStartedApart) {
  const auto cameras = ring_of_cameras();
  const std::vector<double> late{0.0, 6.3, -3.6, 0.4};
  WandOptions options;
  options.choose_clocks = true;
  const auto found = calibrate_wand(
      names_of(cameras), wave_wand(cameras, 120, 0.2, late), kWand, options);
  ASSERT_TRUE(found) << found.error().message();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const SolvedClock& clock = found->rig.clocks[c];
    EXPECT_NEAR(clock.offset_s, 0.1 * late[c], 0.002) << c;
    EXPECT_EQ(clock.offset_sigma_s > 0.0, c > 0);
  }
  EXPECT_LT(worst_position_m(found->rig, cameras), 0.03);
  EXPECT_EQ(found->wand_from_tag.size(), 4U);
  EXPECT_TRUE(found->world_from_wand.empty());
}

TEST(CalibrateWand, LeavesCamerasOfOneClockAlone) {
  const auto cameras = ring_of_cameras();
  WandOptions options;
  options.choose_clocks = true;
  const auto found =
      calibrate_wand(names_of(cameras), wave_wand(cameras, 60, 0.2), kWand, options);
  ASSERT_TRUE(found) << found.error().message();
  for (const SolvedClock& clock : found->rig.clocks) {
    EXPECT_EQ(clock.offset_s, 0.0);
    EXPECT_EQ(clock.offset_sigma_s, 0.0);
  }
  EXPECT_FALSE(found->world_from_wand.empty());
}

TEST(CalibrateWand, FindsTheSimplestLensThatServes) {
  const auto cameras = ring_of_cameras();
  WandOptions options;
  options.choose_lens = true;
  const auto found =
      calibrate_wand(names_of(cameras), wave_wand(cameras, 60, 0.2), kWand, options);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(found->rig.cameras[0].intrinsics.lens, LensModel::kBrownConrady);
}

TEST(CalibrateWand, PutsTheFirstCameraUprightAtTheOrigin) {
  const auto cameras = ring_of_cameras();
  const auto found =
      calibrate_wand(names_of(cameras), wave_wand(cameras, 60, 0.0), kWand);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_LT(glm::length(centre_in_world(found->rig.cameras[0])), 1e-9);
  const glm::dvec3 down =
      inverse(found->rig.cameras[0].camera_from_world).rotation * glm::dvec3(0, 1, 0);
  EXPECT_LT(glm::distance(down, {0.0, -1.0, 0.0}), 1e-9);
}

TEST(CalibrateWand, NamesCamerasWithoutSharedViews) {
  const auto cameras = ring_of_cameras();
  auto waved = wave_wand(cameras, 60, 0.0);
  for (std::size_t c = 0; c < 4; ++c) {
    for (FrameDetections& frame : waved[c].frames) {
      if ((frame.frame % 2 == 0) != (c < 2)) frame.tags.clear();
    }
  }
  const auto found = calibrate_wand(names_of(cameras), waved, kWand);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().cause.find("no shared sighting connects the cameras"),
            std::string::npos);
}

TEST(CalibrateWand, ReportsThatNoTagOfTheWandIsSeen) {
  const auto cameras = ring_of_cameras();
  const auto found = calibrate_wand(
      names_of(cameras), wave_wand(cameras, 10, 0.0), Wand{{{TagId{40}, 0.1}}});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().cause, "no tag of the wand is seen by any camera");
}

}  // namespace
}  // namespace marey::calib
