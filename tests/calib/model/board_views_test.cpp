// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/board_views.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::BoardRecording;
using marey::testing::ring_of_cameras;
using marey::testing::wave_board;

const AprilGrid kBoard{6, 6, 0.1, 0.03, 0, 0.005};

const BoardView* find(const std::vector<BoardView>& views, int camera, int instant) {
  for (const BoardView& view : views) {
    if (view.camera == CameraId{camera} && view.instant == instant) return &view;
  }
  return nullptr;
}

TEST(BoardViews, AreOrderedByCameraThenInstant) {
  const auto cameras = ring_of_cameras();
  const BoardRecording recording = wave_board(cameras, kBoard, 12);
  const auto views = board_views(recording.waved, recording.floor, kBoard);
  ASSERT_GT(views.size(), 12U);
  EXPECT_TRUE(std::is_sorted(
      views.begin(), views.end(), [](const BoardView& a, const BoardView& b) {
        return std::pair(a.camera, a.instant) < std::pair(b.camera, b.instant);
      }));
}

TEST(BoardViews, TakeTheFloorsFramesForOneView) {
  const auto cameras = ring_of_cameras();
  const BoardRecording recording = wave_board(cameras, kBoard, 4);
  const auto views = board_views(recording.waved, recording.floor, kBoard);
  EXPECT_EQ(std::count_if(views.begin(),
                          views.end(),
                          [](const BoardView& v) {
                            return v.instant == kFloorInstant && v.camera == CameraId{0};
                          }),
            1);
}

TEST(BoardViews, AverageTheFloorsNoise) {
  const auto cameras = ring_of_cameras();
  const BoardRecording exact = wave_board(cameras, kBoard, 1);
  BoardRecording noisy = exact;
  marey::testing::Dice dice(3);
  const FrameDetections frame = exact.floor[0].frames[0];
  noisy.floor[0].frames.assign(16, frame);
  for (std::size_t f = 0; f < noisy.floor[0].frames.size(); ++f) {
    noisy.floor[0].frames[f].frame = static_cast<int>(f);
    for (TagDetection& tag : noisy.floor[0].frames[f].tags) {
      tag = marey::testing::disturbed(tag, {0.3, {}, 0.0}, dice);
    }
  }
  const auto views = board_views(noisy.waved, noisy.floor, kBoard);
  const BoardView* floor = find(views, 0, kFloorInstant);
  ASSERT_TRUE(floor);
  ASSERT_EQ(floor->corners.size(), 4 * frame.tags.size());
  double sum_px2 = 0.0;
  for (std::size_t i = 0; i < floor->corners.size(); ++i) {
    const glm::dvec2 off =
        floor->corners[i].pixel_px - frame.tags[i / 4].corners_px[i % 4];
    sum_px2 += 0.5 * glm::dot(off, off);
  }
  // The mean of sixteen frames has a quarter of 0.3 px; a hundred corners determine it to
  // a tenth.
  EXPECT_NEAR(
      std::sqrt(sum_px2 / static_cast<double>(floor->corners.size())), 0.075, 0.02);
  // The systematic part does not average out: sigma is at least three quarters.
  EXPECT_NEAR(floor->corners[0].sigma_px, 0.75 * frame.tags[0].sigma_px, 1e-12);
}

TEST(BoardViews, LeaveAFootOnTheBoardOutOfTheAverage) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kBoard, 1);
  const TagDetection truth = recording.floor[0].frames[0].tags[0];
  for (glm::dvec2& corner : recording.floor[0].frames[2].tags[0].corners_px) {
    corner += glm::dvec2(9.0, 0.0);
  }
  const auto views = board_views(recording.waved, recording.floor, kBoard);
  const BoardView* floor = find(views, 0, kFloorInstant);
  ASSERT_TRUE(floor);
  EXPECT_LT(glm::distance(floor->corners[0].pixel_px, truth.corners_px[0]), 1e-9);
}

TEST(BoardViews, CountAFrameThatIsBothAsFloor) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kBoard, 12);
  // The floor's frames are the first five of the same video.
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    recording.floor[c].source = recording.waved[c].source;
  }
  const auto views = board_views(recording.waved, recording.floor, kBoard);
  EXPECT_FALSE(find(views, 0, 0));
  EXPECT_FALSE(find(views, 0, 4));
  EXPECT_TRUE(find(views, 0, kFloorInstant));
  EXPECT_TRUE(std::any_of(
      views.begin(), views.end(), [](const BoardView& v) { return v.instant > 4; }));
}

TEST(BoardViews, LeaveOutViewsOfTooFewTags) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kBoard, 1);
  auto& tags = recording.waved[0].frames[0].tags;
  ASSERT_GT(tags.size(), 3U);
  tags.resize(3);
  EXPECT_TRUE(find(board_views(recording.waved, recording.floor, kBoard), 0, 0));
  tags.resize(2);
  EXPECT_FALSE(find(board_views(recording.waved, recording.floor, kBoard), 0, 0));
}

TEST(BoardViews, LeaveOutTagsThatAreNotOnTheBoard) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kBoard, 1);
  auto& tags = recording.waved[0].frames[0].tags;
  const std::size_t on_board = tags.size();
  TagDetection stranger = tags.back();
  stranger.id = TagId{40};
  tags.push_back(stranger);
  const auto views = board_views(recording.waved, recording.floor, kBoard);
  ASSERT_TRUE(find(views, 0, 0));
  EXPECT_EQ(find(views, 0, 0)->corners.size(), 4 * on_board);
}

}  // namespace
}  // namespace marey::calib
