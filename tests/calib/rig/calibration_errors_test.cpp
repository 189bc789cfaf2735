// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calib/rig/calibrate_cameras.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::calib {
namespace {

using marey::testing::BoardRecording;
using marey::testing::names_of;
using marey::testing::ring_of_cameras;
using marey::testing::wave_board;

const AprilGrid kMovedBoard{6, 6, 0.1, 0.03, 0, 0.005};
constexpr int kErrorFrames = 40;

Error error_of(const std::vector<Camera>& cameras,
               const BoardRecording& recording,
               const AprilGrid& board = kMovedBoard) {
  const auto rig =
      calibrate_cameras(names_of(cameras), recording.waved, recording.floor, board);
  EXPECT_FALSE(rig);
  return rig ? Error{} : rig.error();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CalibrateCameras, ReportsTheVideoWithoutTheBoard) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  for (FrameDetections& frame : recording.waved[2].frames) frame.tags.clear();
  for (FrameDetections& frame : recording.floor[2].frames) frame.tags.clear();
  const Error error = error_of(cameras, recording);
  EXPECT_EQ(error.where, "calibration/cam2.mp4");
  EXPECT_EQ(error.cause,
            "no tag of the calibration board (ids 0 to 35) is seen in any frame");
}

TEST(CalibrateCameras, ReportsTheVideoWithTooFewViewsOfTheBoard) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  int left = 2;
  for (FrameDetections& frame : recording.waved[1].frames) {
    if (frame.tags.size() >= 6 && left > 0) {
      --left;
    } else {
      frame.tags.clear();
    }
  }
  const Error error = error_of(cameras, recording);
  EXPECT_EQ(error.code, Errc::kBadInput);
  EXPECT_EQ(error.where, "calibration/cam1.mp4");
  EXPECT_TRUE(contains(error.cause,
                       "too few views of the board to calibrate this camera: 2 frames"))
      << error.cause;
}

TEST(CalibrateCameras, NamesTheGroupsThatNeverSeeTheBoardTogether) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (FrameDetections& frame : recording.waved[c].frames) {
      if ((c == 3) != (frame.frame % 2 == 0)) frame.tags.clear();
    }
  }
  for (FrameDetections& frame : recording.floor[3].frames) frame.tags.clear();
  const Error error = error_of(cameras, recording);
  EXPECT_TRUE(contains(error.cause,
                       "{cam0, cam1, cam2} sees the board at the same time as a camera "
                       "of {cam3}"))
      << error.cause;
  EXPECT_TRUE(contains(error.next, "where both groups see it")) << error.next;
}

TEST(CalibrateCameras, AsksForAFloor) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  for (CameraDetections& camera : recording.floor) {
    for (FrameDetections& frame : camera.frames) frame.tags.clear();
  }
  const Error error = error_of(cameras, recording);
  EXPECT_TRUE(contains(error.cause, "no camera sees the board lying on the floor"))
      << error.cause;
}

// A printed face is not visible through the board, but a mirrored print is: the cameras
// then see a board from behind.
TEST(CalibrateCameras, NoticesABoardThatLiesFaceDown) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  const RigidTransform face_down{rotation_from_vector({glm::radians(90.0), 0.0, 0.0}),
                                 glm::dvec3(0.0)};
  const RigidTransform upright_tag{rotation_from_vector({glm::radians(180.0), 0.0, 0.0}),
                                   glm::dvec3(0.0)};
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (FrameDetections& frame : recording.floor[c].frames) {
      frame.tags.clear();
      for (int id = 0; id < kMovedBoard.tag_count(); ++id) {
        RigidTransform board_from_tag = upright_tag;
        board_from_tag.translation = 0.5 * (*kMovedBoard.corner_in_board(TagId{id}, 0) +
                                            *kMovedBoard.corner_in_board(TagId{id}, 2));
        const auto tag = marey::testing::see_tag(cameras[c],
                                                 face_down * board_from_tag,
                                                 TagId{id},
                                                 kMovedBoard.tag_size_m,
                                                 glm::radians(180.0));
        if (tag) frame.tags.push_back(*tag);
      }
    }
  }
  const Error error = error_of(cameras, recording);
  EXPECT_EQ(error.where, "floor/cam0.mp4");
  EXPECT_TRUE(contains(error.cause, "below the floor")) << error.cause;
  EXPECT_EQ(error.next, "lay the board on the floor with its printed face up");
}

TEST(CalibrateCameras, NamesTwoFloorVideosThatAreSwapped) {
  const auto cameras = ring_of_cameras();
  for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 3}}) {
    BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
    std::swap(recording.floor[a].frames, recording.floor[b].frames);
    const Error error = error_of(cameras, recording);
    EXPECT_EQ(error.where,
              "floor/cam" + std::to_string(a) + ".mp4 and floor/cam" + std::to_string(b) +
                  ".mp4");
    EXPECT_TRUE(contains(error.cause, "look exchanged")) << error.cause;
    EXPECT_TRUE(contains(error.next, "exchange them")) << error.next;
  }
}

TEST(CalibrateCameras, NamesACameraThatWasMovedBeforeTheFloorTrial) {
  const auto cameras = ring_of_cameras();
  auto moved = cameras;
  // 20 cm to its right.
  moved[2].camera_from_world.translation.x -= 0.2;
  BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  recording.floor[2] = wave_board(moved, kMovedBoard, kErrorFrames).floor[2];
  const Error error = error_of(cameras, recording);
  EXPECT_EQ(error.where, "floor/cam2.mp4");
  EXPECT_TRUE(contains(error.next, "no camera was moved")) << error.next;
}

TEST(CalibrateCameras, NoticesAWrongGap) {
  // Printed with gaps of 30 mm, declared with 20: a world of 120/130 of its size would
  // fit every corner if the shrinkage of tags were unlimited.
  const auto cameras = ring_of_cameras();
  const BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  AprilGrid declared = kMovedBoard;
  declared.gap_m = 0.02;
  const Error error = error_of(cameras, recording, declared);
  EXPECT_EQ(error.cause,
            "the board's black squares measure 0.92 times the size that the gaps between "
            "them require");
  EXPECT_TRUE(contains(error.next, "correct tag_size_m or gap_m of [board]"))
      << error.next;
}

// Every view has a shape that is impossible for a flat board: no camera fits even one of
// them.
TEST(CalibrateCameras, ReportsTheSeenArrangementOfTagsForAWrongDeclaration) {
  const auto cameras = ring_of_cameras();
  marey::testing::Disturbance noise;
  noise.noise_px = 0.3;
  const BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames, noise);
  struct Case {
    int columns, rows, first_id;
    const char* changes;
  };
  for (const Case& wrong : {Case{5, 5, 0, " columns = 6, rows = 6"},
                            Case{9, 4, 0, " columns = 6, rows = 6"},
                            Case{10, 10, 0, " columns = 6, rows = 6"},
                            Case{6, 6, 100, " first_id = 0"},
                            Case{6, 6, 1, " first_id = 0"}}) {
    AprilGrid declared = kMovedBoard;
    declared.columns = wrong.columns;
    declared.rows = wrong.rows;
    declared.first_id = wrong.first_id;
    const Error error = error_of(cameras, recording, declared);
    EXPECT_EQ(error.code, Errc::kBadInput);
    EXPECT_TRUE(contains(error.cause,
                         "are arranged as on a board of 6 x 6 that begins with id 0"))
        << error.cause;
    EXPECT_TRUE(contains(error.next, wrong.changes)) << error.next;
  }
}

/// Frames of a board held parallel to the image plane, with its lower left corner at the
/// given pixel.
std::vector<FrameDetections> square_on(const std::vector<glm::dvec2>& places_px) {
  constexpr double kPxPerMetre = 400.0;
  std::vector<FrameDetections> frames;
  for (const glm::dvec2& place : places_px) {
    FrameDetections frame;
    frame.frame = static_cast<int>(frames.size());
    for (int id = 0; id < kMovedBoard.tag_count(); ++id) {
      TagDetection tag;
      tag.id = TagId{id};
      for (int corner = 0; corner < 4; ++corner) {
        const glm::dvec3 p = *kMovedBoard.corner_in_board(tag.id, corner);
        tag.corners_px[static_cast<std::size_t>(corner)] =
            place + kPxPerMetre * glm::dvec2(p.x, -p.y);
      }
      frame.tags.push_back(tag);
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

TEST(CalibrateCameras, DistinguishesAStillBoardFromAnUntiltedBoard) {
  const auto cameras = ring_of_cameras();
  BoardRecording recording = wave_board(cameras, kMovedBoard, kErrorFrames);
  // The floor shows a board that is tilted.
  for (FrameDetections& frame : recording.floor[0].frames) frame.tags.clear();
  recording.waved[0].frames =
      square_on(std::vector<glm::dvec2>(kErrorFrames, glm::dvec2(500.0, 600.0)));
  const Error still = error_of(cameras, recording);
  EXPECT_TRUE(contains(still.cause, "the board lies still in the 40 frames"))
      << still.cause;
  std::vector<glm::dvec2> places;
  for (int frame = 0; frame < kErrorFrames; ++frame) {
    places.emplace_back(100.0 + 20.0 * frame, 400.0 + 5.0 * frame);
  }
  recording.waved[0].frames = square_on(places);
  const Error flat = error_of(cameras, recording);
  EXPECT_TRUE(contains(flat.cause, "never tilted enough in the 40 frames")) << flat.cause;
}

}  // namespace
}  // namespace marey::calib
