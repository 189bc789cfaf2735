// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/survey_boards.h"

#include <array>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "capture/search/detect_videos.h"
#include "capture/search/detect_wrong_board.h"
#include "tests/capture/board_artist.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::capture {
namespace {

using testing::ScratchFolder;
using tests::BoardPlace;

const BoardPlace kPlace{{{120, 400}, {420, 430}, {460, 190}, {150, 130}}};
const BoardPlace kMirrored{{{420, 430}, {120, 400}, {150, 130}, {460, 190}}};

CharucoBoard charuco() {
  CharucoBoard board;
  board.rows = 5;
  board.columns = 7;
  board.dictionary = "DICT_5X5_100";
  return board;
}

/// A folder of three pictures of a board.
template <class Board>
void record_board(const ScratchFolder& folder,
                  const Board& board,
                  const BoardPlace& place = kPlace) {
  const cv::Mat picture = tests::draw_board(tests::flat_picture(board), 640, 480, place);
  for (const char* name : {"0.png", "1.png", "2.png"}) {
    ASSERT_TRUE(cv::imwrite((folder / name).string(), picture));
  }
}

/// Expects codes ("DICT_5X5_100"; empty: a chessboard) and parts of both texts.
void expect_seen(const ScratchFolder& folder,
                 const CalibrationTarget& target,
                 const std::string& codes,
                 const std::string& what,
                 const std::string& remedy) {
  const auto seen = survey_boards(folder.path(), target);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->kind,
            codes.empty() ? AlternativeKind::kChessboard : AlternativeKind::kMarkers);
  EXPECT_EQ(seen->codes, codes);
  EXPECT_EQ(seen->is_mirrored, what == "mirrored");
  EXPECT_NE(seen->what.find(what), std::string::npos) << seen->what;
  EXPECT_NE(seen->remedy.find(remedy), std::string::npos) << seen->remedy;
}

TEST(SurveyBoards, ReturnsTheDictionaryInView) {
  const ScratchFolder folder;
  record_board(folder, charuco());
  CharucoBoard wanted = charuco();
  wanted.dictionary = "DICT_4X4_50";
  expect_seen(folder,
              wanted,
              "DICT_5X5_50",
              "markers 0 to 16 of DICT_5X5_50",
              "dictionary = \"DICT_5X5_50\"");
  expect_seen(
      folder, Chessboard{}, "DICT_5X5_50", "of DICT_5X5_50", "type = \"charuco\"");
}

TEST(SurveyBoards, DetectsABoardOfAnotherSize) {
  const ScratchFolder folder;
  record_board(folder, charuco());
  CharucoBoard wanted = charuco();
  wanted.rows = 7;
  wanted.columns = 5;
  expect_seen(folder, wanted, "DICT_5X5_100", "in other places", "rows and columns");
}

TEST(SurveyBoards, DetectsBlackAndWhiteExchanged) {
  const ScratchFolder folder;
  CharucoBoard inverted = charuco();
  inverted.is_inverted = true;
  record_board(folder, inverted);
  expect_seen(
      folder, charuco(), "DICT_5X5_100", "black and white", "write inverted = true");
}

TEST(SurveyBoards, DetectsAMirroredBoard) {
  const ScratchFolder folder;
  record_board(folder, charuco(), kMirrored);
  expect_seen(folder, charuco(), "DICT_5X5_100", "mirrored", "two_sided = true");
}

TEST(SurveyBoards, DetectsAprilTags) {
  const ScratchFolder folder;
  CharucoBoard tags = charuco();
  tags.dictionary = "DICT_APRILTAG_36h11";
  record_board(folder, tags);
  expect_seen(folder,
              charuco(),
              "DICT_APRILTAG_36h11",
              "of DICT_APRILTAG_36h11",
              "type = \"aprilgrid\"");
}

TEST(SurveyBoards, CountsTheSquaresOfAChessboard) {
  const ScratchFolder folder;
  record_board(folder, Chessboard{.rows = 6, .columns = 9, .square_size_m = 0.03});
  expect_seen(folder,
              Chessboard{.rows = 5, .columns = 8, .square_size_m = 0.03},
              "",
              "9 x 6 squares",
              "columns = 9 and rows = 6");
  expect_seen(folder, charuco(), "", "9 x 6 squares", "type = \"chessboard\"");
}

TEST(SurveyBoards, ReturnsNothingForAnEmptyPicture) {
  const ScratchFolder folder;
  ASSERT_TRUE(cv::imwrite((folder / "0.png").string(),
                          cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))));
  EXPECT_FALSE(survey_boards(folder.path(), charuco()));
  EXPECT_FALSE(survey_boards(folder / "nothing", charuco()));
}

CameraInput input_of(const ScratchFolder& folder) {
  CameraInput input;
  input.path = folder.path() / "*.png";
  return input;
}

TEST(DetectWrongBoard, ReturnsTheBoardInView) {
  const ScratchFolder first;
  const ScratchFolder second;
  ASSERT_TRUE(cv::imwrite((first / "0.png").string(),
                          cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))));
  record_board(second, charuco());
  CharucoBoard wanted = charuco();
  wanted.dictionary = "DICT_4X4_50";
  const std::array inputs{input_of(first), input_of(second)};
  const auto other = detect_wrong_board(inputs, wanted);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->input, 1U);
  EXPECT_EQ(other->frames, 3);
  EXPECT_NE(other->seen.what.find("of DICT_5X5_50"), std::string::npos);
}

TEST(DetectWrongBoard, StopsAtOneCameraThatSeesTheTarget) {
  const ScratchFolder first;
  const ScratchFolder second;
  record_board(first, Chessboard{.rows = 6, .columns = 9, .square_size_m = 0.03});
  record_board(second, charuco());
  const std::array inputs{input_of(first), input_of(second)};
  EXPECT_FALSE(detect_wrong_board(inputs, charuco()));
}

TEST(DetectWrongBoard, IgnoresWornTags) {
  const ScratchFolder folder;
  CharucoBoard tags = charuco();
  tags.dictionary = "DICT_APRILTAG_36h11";
  record_board(folder, tags);
  const std::array inputs{input_of(folder)};
  const Chessboard wanted{.rows = 6, .columns = 9, .square_size_m = 0.03};
  const auto shows_tags = [](const std::optional<OtherBoard>& other) {
    return other && other->seen.what.find("APRILTAG_36h11") != std::string::npos;
  };
  EXPECT_TRUE(shows_tags(detect_wrong_board(inputs, wanted)));
  TagFamilyUse worn;
  for (int id = 0; id < tags.marker_count(); ++id) worn.ids.push_back(TagId{id});
  // Only its squares remain visible.
  EXPECT_FALSE(shows_tags(detect_wrong_board(inputs, wanted, std::array{worn})));
}

TEST(DetectWrongBoard, ReturnsNothingWithoutABoard) {
  const ScratchFolder folder;
  ASSERT_TRUE(cv::imwrite((folder / "0.png").string(),
                          cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))));
  EXPECT_FALSE(detect_wrong_board(std::array{input_of(folder)}, charuco()));
}

TEST(DetectVideos, FindsTheTargetsPointsInEveryFrame) {
  const ScratchFolder folder;
  record_board(folder, charuco());
  CameraInput input;
  input.path = folder.path() / "*.png";
  input.rate = FrameRate{10.0};
  DetectVideosOptions options;
  options.find_tags = false;
  options.target = charuco();
  const auto found = detect_tags_in_videos(std::array{input}, options);
  ASSERT_TRUE(found) << found.error().message();
  ASSERT_EQ(found->front().frames.size(), 3U);
  for (const FrameDetections& frame : found->front().frames) {
    EXPECT_TRUE(frame.tags.empty());
    EXPECT_EQ(frame.points.size(), 24U);
  }
  CharucoBoard unknown = charuco();
  unknown.dictionary = "DICT_3X3";
  options.target = unknown;
  EXPECT_FALSE(detect_tags_in_videos(std::array{input}, options));
}

}  // namespace
}  // namespace marey::capture
