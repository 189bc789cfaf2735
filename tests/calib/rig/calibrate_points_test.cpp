// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calib/rig/calibrate_cameras.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::webcam_at;

constexpr double kSquare_m = 0.06;
constexpr double kHalfTurn_rad = std::numbers::pi;

CharucoBoard board() {
  CharucoBoard b;
  b.rows = 8;
  b.columns = 10;
  b.square_size_m = kSquare_m;
  return b;
}

std::vector<Camera> three_cameras() {
  return {webcam_at("cam0", {-1.0, 1.2, 2.0}, {0.0, 1.0, 0.0}),
          webcam_at("cam1", {0.1, 1.4, 2.2}, {0.0, 1.0, 0.0}),
          webcam_at("cam2", {1.1, 1.0, 1.9}, {0.0, 1.0, 0.0})};
}

struct Scene {
  double noise_px = 0.0;
  double bend_m = 0.0;  ///< Rise of the board's left and right ends.
  bool mirrored = false;
  std::array<double, 3> late_s{};  ///< Per camera.
  double seconds = 6.0;
  double rest_s = 0.0;  ///< Duration before the board begins to swing.
};

/// The board faces the cameras and swings.
RigidTransform world_from_board(double time_s) {
  const glm::dquat turn =
      rotation_from_vector({0.5 * std::sin(2.1 * time_s), 0.0, 0.0}) *
      rotation_from_vector({0.0, 0.6 * std::sin(1.7 * time_s + 0.4), 0.0}) *
      rotation_from_vector({0.0, 0.0, 0.5 * std::sin(1.3 * time_s)});
  const glm::dvec3 middle(0.3 * std::sin(1.9 * time_s),
                          1.1 + 0.2 * std::sin(2.6 * time_s),
                          0.35 * std::sin(1.1 * time_s));
  return {turn, middle - turn * glm::dvec3(5.0 * kSquare_m, 4.0 * kSquare_m, 0.0)};
}

std::vector<CameraDetections> film(const std::vector<Camera>& cameras,
                                   const Scene& scene) {
  constexpr double kHz = 15.0;
  const int frames = static_cast<int>(scene.seconds * kHz);
  auto out = marey::testing::unseeing(cameras, frames, kHz, "calibration");
  marey::testing::Dice dice(8);
  const CharucoBoard b = board();
  const int across = b.columns - 1;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (int f = 0; f < frames; ++f) {
      const RigidTransform pose =
          world_from_board(std::max(0.0, f / kHz + scene.late_s[c] - scene.rest_s));
      for (int point = 0; point < across * (b.rows - 1); ++point) {
        const int shown =
            scene.mirrored ? point - point % across + across - 1 - point % across : point;
        glm::dvec3 p = *inner_corner_in_board(b.rows, b.columns, kSquare_m, shown);
        const double x = (p.x - 5.0 * kSquare_m) / (4.0 * kSquare_m);
        p.z += scene.bend_m * x * x;
        const auto pixel = project(cameras[c], pose * p);
        if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x > 1279 || pixel->y > 719) {
          continue;
        }
        out[c].frames[static_cast<std::size_t>(f)].points.push_back(
            {point,
             *pixel + glm::dvec2(dice.noise(scene.noise_px), dice.noise(scene.noise_px)),
             0.1});
      }
    }
  }
  return out;
}

Result<CalibratedRig> calibrate_from_points(const std::vector<Camera>& cameras,
                                            const Scene& scene,
                                            const RigOptions& rig_options = {},
                                            bool find_warp = false) {
  const CalibrateOptions options{rig_options, find_warp};
  return calibrate_cameras(
      marey::testing::names_of(cameras), film(cameras, scene), {}, board(), options);
}

/// Distances between cameras do not depend on the world's frame.
double worst_distance_m(const CalibratedRig& rig, const std::vector<Camera>& truth) {
  double worst = 0.0;
  for (std::size_t a = 0; a < truth.size(); ++a) {
    for (std::size_t b = a + 1; b < truth.size(); ++b) {
      worst = std::max(
          worst,
          std::abs(glm::distance(centre_in_world(rig.cameras[a]),
                                 centre_in_world(rig.cameras[b])) -
                   glm::distance(centre_in_world(truth[a]), centre_in_world(truth[b]))));
    }
  }
  return worst;
}

TEST(CalibratePoints, RecoverTheRigFromExactCornersOfSquares) {
  const auto cameras = three_cameras();
  const auto rig = calibrate_from_points(cameras, {});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_LT(worst_distance_m(*rig, cameras), 2e-5);
  EXPECT_LT(rig->rms_px, 1e-3);
  // Without a floor, the first camera is the origin of the world.
  EXPECT_LT(glm::length(centre_in_world(rig->cameras[0])), 1e-9);
}

TEST(CalibratePoints, StayNearUnderNoise) {
  const auto cameras = three_cameras();
  const auto rig = calibrate_from_points(cameras, {.noise_px = 0.1});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_LT(worst_distance_m(*rig, cameras), 2e-3);
  EXPECT_NEAR(rig->rms_px, 0.141, 0.01);
}

TEST(CalibratePoints, RecoverFisheyes) {
  auto cameras = three_cameras();
  for (Camera& camera : cameras) {
    camera.intrinsics.lens = LensModel::kFisheye;
    camera.intrinsics.focal_px = {560.0, 560.0};
    camera.intrinsics.distortion = {-0.02, 0.004};
  }
  const auto rig = calibrate_from_points(
      cameras, {.noise_px = 0.05, .seconds = 4.0}, {.lens = LensModel::kFisheye});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->cameras[0].intrinsics.lens, LensModel::kFisheye);
  EXPECT_NEAR(rig->cameras[1].intrinsics.focal_px.x, 560.0, 3.0);
  EXPECT_LT(worst_distance_m(*rig, cameras), 6e-3);
}

TEST(CalibratePoints, ChooseTheLensThatPredictsBest) {
  // Near enough for the board to cover half of a fisheye's image.
  std::vector<Camera> cameras{webcam_at("cam0", {-0.35, 1.2, 0.75}, {0.0, 1.0, 0.0}),
                              webcam_at("cam1", {0.3, 1.0, 0.8}, {0.0, 1.0, 0.0})};
  for (Camera& camera : cameras) {
    camera.intrinsics.lens = LensModel::kFisheye;
    camera.intrinsics.focal_px = {420.0, 420.0};
    camera.intrinsics.distortion = {-0.05, 0.01};
  }
  const Scene scene{.noise_px = 0.05, .seconds = 2.0};
  const auto rig = calibrate_from_points(cameras, scene, {.choose_lens = true});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->cameras[0].intrinsics.lens, LensModel::kFisheye);
}

TEST(CalibratePoints, KeepTheSimplestLensThatServes) {
  const Scene scene{.noise_px = 0.05, .seconds = 2.0};
  const auto rig = calibrate_from_points(three_cameras(), scene, {.choose_lens = true});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->cameras[0].intrinsics.lens, LensModel::kBrownConrady);
}

TEST(CalibratePoints, RefuseAMirroredBoard) {
  const auto rig =
      calibrate_from_points(three_cameras(), {.mirrored = true, .seconds = 3.0});
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().cause,
            "the cameras see the board from behind: its corners are mirrored");
}

TEST(CalibratePoints, FindABentBoardAndLeaveAFlatOneFlat) {
  const auto cameras = three_cameras();
  const auto bent = calibrate_from_points(
      cameras, {.noise_px = 0.1, .bend_m = 0.002, .seconds = 4.0}, {}, true);
  ASSERT_TRUE(bent) << bent.error().message();
  ASSERT_TRUE(bent->warp_m);
  // The ends of the visible part are the corners at 4 squares from the middle.
  EXPECT_NEAR((*bent->warp_m)[0], 0.002, 2e-4);
  EXPECT_NEAR((*bent->warp_m)[1], 0.0, 2e-4);
  const auto flat =
      calibrate_from_points(cameras, {.noise_px = 0.1, .seconds = 4.0}, {}, true);
  ASSERT_TRUE(flat) << flat.error().message();
  EXPECT_FALSE(flat->warp_m);
}

TEST(CalibratePoints, SolveForClocksThatStartApart) {
  const auto cameras = three_cameras();
  const auto rig = calibrate_from_points(
      cameras,
      {.noise_px = 0.1, .late_s = {0.0, 0.2613, -0.1471}, .seconds = 5.0},
      {.solve_offsets = true, .max_offset_s = 0.6});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_NEAR(rig->clocks[1].offset_s, 0.2613, 1e-3);
  EXPECT_NEAR(rig->clocks[2].offset_s, -0.1471, 1e-3);
  EXPECT_GT(rig->clocks[1].offset_sigma_s, 1e-6);
  EXPECT_LT(rig->clocks[1].offset_sigma_s, 1e-3);
  EXPECT_LT(worst_distance_m(*rig, cameras), 4e-3);
}

// Three cases of the other clocks relative to the first: less than a frame apart, some
// frames apart, and equal.
TEST(CalibratePoints, FindOutThatClocksAreApart) {
  const auto cameras = three_cameras();
  for (const double late_s : {0.0087, 0.2613}) {
    const auto rig = calibrate_from_points(
        cameras,
        {.noise_px = 0.1, .late_s = {0.0, late_s, -0.02}, .seconds = 5.0},
        {.choose_clocks = true, .max_offset_s = 0.6});
    ASSERT_TRUE(rig) << rig.error().message();
    EXPECT_NEAR(rig->clocks[1].offset_s, late_s, 1e-3);
    EXPECT_NEAR(rig->clocks[2].offset_s, -0.02, 1e-3);
    EXPECT_GT(rig->clocks[1].offset_sigma_s, 0.0);
    EXPECT_LT(worst_distance_m(*rig, cameras), 4e-3);
  }
}

TEST(CalibratePoints, LeaveClocksAloneThatRunTogether) {
  const auto cameras = three_cameras();
  const auto rig = calibrate_from_points(
      cameras, {.noise_px = 0.1, .seconds = 5.0}, {.choose_clocks = true});
  const auto shared = calibrate_from_points(cameras, {.noise_px = 0.1, .seconds = 5.0});
  ASSERT_TRUE(rig && shared);
  EXPECT_EQ(rig->clocks[1].offset_sigma_s, 0.0);
  EXPECT_EQ(centre_in_world(rig->cameras[1]), centre_in_world(shared->cameras[1]));
}

TEST(CalibratePoints, FindClocksOfManyFramesInALongRest) {
  // The board rests for a third of the time: frames of any times then match.
  const auto cameras = three_cameras();
  const auto rig = calibrate_from_points(
      cameras,
      {.noise_px = 0.1, .late_s = {0.0, 0.0, 1.2}, .seconds = 9.0, .rest_s = 3.0},
      {.choose_clocks = true, .max_offset_s = 2.0});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_NEAR(rig->clocks[1].offset_s, 0.0, 1e-3);
  EXPECT_NEAR(rig->clocks[2].offset_s, 1.2, 1e-3);
  EXPECT_LT(rig->rms_px, 0.2);
  EXPECT_LT(worst_distance_m(*rig, cameras), 4e-3);
}

// Line delays are not mistaken for clock offsets, and vice versa.
TEST(CalibratePoints, ChooseClocksWithLineDelays) {
  const auto cameras = three_cameras();
  for (const double late_s : {0.0, 0.1613}) {
    const auto rig = calibrate_from_points(
        cameras,
        {.noise_px = 0.1, .late_s = {0.0, late_s, 0.0}, .seconds = 3.0},
        {.solve_line_delays = true, .choose_clocks = true, .max_offset_s = 0.3});
    ASSERT_TRUE(rig) << rig.error().message();
    EXPECT_NEAR(rig->clocks[1].offset_s, late_s, 1e-3);
    EXPECT_EQ(rig->clocks[1].offset_sigma_s > 0.0, late_s > 0.0);
    for (const SolvedClock& clock : rig->clocks) {
      EXPECT_NEAR(clock.line_delay_s, 0.0, 3e-6);
      EXPECT_GT(clock.line_delay_sigma_s, 0.0);
    }
    // Frames of a board in constant motion.
    EXPECT_EQ(rig->quality[1].views, 45);
  }
}

TEST(CalibratePoints, HoldLensesThatAreGiven) {
  const auto cameras = three_cameras();
  const auto rig = calibrate_from_points(
      cameras,
      {.noise_px = 0.1, .seconds = 4.0},
      {.lenses = {cameras[0].intrinsics, std::nullopt, cameras[2].intrinsics}});
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->cameras[0].intrinsics.parameters(), cameras[0].intrinsics.parameters());
  EXPECT_EQ(rig->cameras[2].intrinsics.parameters(), cameras[2].intrinsics.parameters());
  EXPECT_NE(rig->cameras[1].intrinsics.focal_px, cameras[1].intrinsics.focal_px);
  EXPECT_EQ(rig->quality[0].focal_sigma_px, 0.0);
  EXPECT_GT(rig->quality[1].focal_sigma_px, 0.0);
  EXPECT_LT(worst_distance_m(*rig, cameras), 2e-3);
}

TEST(CalibratePoints, JudgeThemselvesByFramesAndCamerasLeftOut) {
  const auto cameras = three_cameras();
  const auto rig = calibrate_from_points(
      cameras, {.noise_px = 0.1, .seconds = 4.0}, {.cross_validate = true});
  ASSERT_TRUE(rig) << rig.error().message();
  ASSERT_TRUE(rig->cross_validation);
  const CrossValidation& v = *rig->cross_validation;
  EXPECT_NEAR(v.seen_rms_px, 0.141, 0.01);
  EXPECT_NEAR(v.held_out_rms_px, 0.141, 0.01);
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_TRUE(v.held_out_camera_px[c]);
    // The other cameras determine the board's pose to a few tenths of a millimetre.
    EXPECT_LT(*v.held_out_camera_px[c], 0.3);
    EXPECT_LT(v.centre_apart_m[c], 5e-3);
  }
}

TEST(CalibratePoints, NameFramesThatStray) {
  const auto cameras = three_cameras();
  auto waved = film(cameras, {.noise_px = 0.1, .seconds = 4.0});
  auto& frame = waved[1].frames[20];
  ASSERT_GT(frame.points.size(), 10U);
  for (std::size_t i = 0; i < 5; ++i) frame.points[i].pixel_px.x += 12.0;
  const auto rig =
      calibrate_cameras(marey::testing::names_of(cameras), waved, {}, board());
  ASSERT_TRUE(rig) << rig.error().message();
  ASSERT_FALSE(rig->outlier_frames.empty());
  EXPECT_EQ(rig->outlier_frames[0].camera, CameraId{1});
  EXPECT_EQ(rig->outlier_frames[0].frame, 20);
  EXPECT_EQ(rig->outlier_frames[0].sightings, 5);
  EXPECT_NEAR(rig->outlier_frames[0].median_error_px, 12.0, 0.5);
}

}  // namespace
}  // namespace marey::calib
