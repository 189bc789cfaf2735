// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/place_cameras.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::BoardRecording;
using marey::testing::ring_of_cameras;
using marey::testing::wave_board;

const AprilGrid kPlacedBoard{6, 6, 0.1, 0.03, 0, 0.005};

std::vector<Intrinsics> intrinsics_of(const std::vector<Camera>& cameras) {
  std::vector<Intrinsics> out;
  for (const Camera& camera : cameras) out.push_back(camera.intrinsics);
  return out;
}

Result<RigGuess> place(const std::vector<Camera>& cameras,
                       const BoardRecording& recording) {
  return place_cameras(board_views(recording.waved, recording.floor, kPlacedBoard),
                       intrinsics_of(cameras),
                       marey::testing::names_of(cameras),
                       kPlacedBoard);
}

double worst_centre_m(const RigGuess& guess, const std::vector<Camera>& cameras) {
  double worst = 0.0;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    worst = std::max(worst,
                     glm::distance(inverse(guess.camera_from_world[c]).translation,
                                   centre_in_world(cameras[c])));
  }
  return worst;
}

TEST(WorldFromFloorBoard, LaysTheBoardFaceUpOnItsBack) {
  const RigidTransform world_from_board = world_from_floor_board(kPlacedBoard);
  const auto direction = [&](const glm::dvec3& d) {
    return world_from_board.rotation * d;
  };
  EXPECT_LT(glm::distance(direction({1, 0, 0}), {1, 0, 0}), 1e-15);
  EXPECT_LT(glm::distance(direction({0, 1, 0}), {0, 0, -1}), 1e-15);
  EXPECT_LT(glm::distance(direction({0, 0, 1}), {0, 1, 0}), 1e-15);
  EXPECT_EQ(world_from_board.translation, glm::dvec3(0.0, 0.005, 0.0));
}

TEST(PlaceCameras, FindsEveryCameraFromExactViews) {
  const auto cameras = ring_of_cameras();
  const auto guess = place(cameras, wave_board(cameras, kPlacedBoard, 60));
  ASSERT_TRUE(guess) << guess.error().message();
  // OpenCV's planar pose takes rays as floats, good to 1e-5 m each; a few are chained.
  EXPECT_LT(worst_centre_m(*guess, cameras), 1e-3 /* m */);
}

TEST(PlaceCameras, IsNotLedAstrayByAFewWrongViews) {
  const auto cameras = ring_of_cameras();
  const auto guess =
      place(cameras, wave_board(cameras, kPlacedBoard, 60, {0.2, {}, 0.05}));
  ASSERT_TRUE(guess) << guess.error().message();
  // Accurate enough for the bundle, which converges from a tenth of the distance.
  EXPECT_LT(worst_centre_m(*guess, cameras), 0.3 /* m */);
}

TEST(PlaceCameras, NamesTheGroupsThatNeverSeeTheBoardTogether) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kPlacedBoard, 60);
  // cam0 and cam1 see the even frames, cam2 and cam3 the odd ones, only cam0 the floor.
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (FrameDetections& frame : recording.waved[c].frames) {
      const bool first_group = c < 2;
      if (first_group != (frame.frame % 2 == 0)) frame.tags.clear();
    }
    if (c == 0) continue;
    for (FrameDetections& frame : recording.floor[c].frames) frame.tags.clear();
  }
  const auto guess = place(cameras, recording);
  ASSERT_FALSE(guess);
  EXPECT_EQ(guess.error().code, Errc::kBadInput);
  EXPECT_EQ(guess.error().cause,
            "no camera of {cam0, cam1} sees the board at the same time as a camera of "
            "{cam2, cam3}");
}

TEST(PlaceCameras, AsksForAFloor) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kPlacedBoard, 60);
  for (CameraDetections& camera : recording.floor) {
    for (FrameDetections& frame : camera.frames) frame.tags.clear();
  }
  const auto guess = place(cameras, recording);
  ASSERT_FALSE(guess);
  EXPECT_EQ(guess.error().cause, "no camera sees the board lying on the floor");
}

}  // namespace
}  // namespace marey::calib
