// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/boards/find_board_points.h"

#include <cmath>
#include <cstddef>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/capture/board_artist.h"
#include "tests/capture/tag_artist.h"

namespace marey::capture {
namespace {

using tests::BoardPlace;
using tests::frame_of;

constexpr double kExactPx = 0.1;  // Error of 6 x 6 samples a pixel, with a margin.

CharucoBoard charuco() {
  CharucoBoard board;
  board.rows = 5;
  board.columns = 7;
  board.square_size_m = 0.04;
  board.marker_size_m = 0.03;
  board.dictionary = "DICT_5X5_100";
  return board;
}

Chessboard chessboard() {
  return {.rows = 6, .columns = 9, .square_size_m = 0.03};
}

/// Tilted like a hand-held board; a square is about 40 px.
const BoardPlace kTilted{{{120, 400}, {420, 430}, {460, 190}, {150, 130}}};

BoardPlace turned_half(const BoardPlace& place) {
  return {place[2], place[3], place[0], place[1]};
}

template <class Board>
std::vector<PointDetection> points_in(const cv::Mat& picture, const Board& board) {
  auto finder = BoardFinder::create(board);
  EXPECT_TRUE(finder);
  return finder->find(frame_of(picture));
}

template <class Board>
std::vector<PointDetection> points_of(const Board& board, const BoardPlace& place) {
  return points_in(tests::draw_board(tests::flat_picture(board), 640, 480, place), board);
}

/// Returns the largest distance of a point from the drawn point of its number. [px]
template <class Board>
double worst_px(const std::vector<PointDetection>& points,
                const Board& board,
                const BoardPlace& place) {
  double worst = 0.0;
  for (const PointDetection& point : points) {
    worst = std::max(worst,
                     glm::distance(point.pixel_px,
                                   tests::true_corner_px(
                                       board.rows, board.columns, point.point, place)));
  }
  return worst;
}

template <class Board>
std::size_t corner_count(const Board& board) {
  return static_cast<std::size_t>((board.rows - 1) * (board.columns - 1));
}

/// Expects all corners, each with its own number at its drawn position.
template <class Board>
void expect_exact(const Board& board, const BoardPlace& place) {
  const auto points = points_of(board, place);
  ASSERT_EQ(points.size(), corner_count(board));
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].point, static_cast<int>(i));
  }
  EXPECT_LT(worst_px(points, board, place), kExactPx);
}

TEST(FindBoardPoints, FindsEveryCornerOfACharucoBoardThatOpenCvDrew) {
  expect_exact(charuco(), kTilted);
  expect_exact(charuco(), turned_half(kTilted));
}

TEST(FindBoardPoints, KnowsTheOldAndTheNewPatternOfEvenRowsApart) {
  CharucoBoard board = charuco();
  board.rows = 6;
  expect_exact(board, kTilted);
  board.is_legacy = true;
  expect_exact(board, kTilted);
}

// Except for some markers at its edge, a board of the old pattern equals one of the new
// pattern whose columns begin one square later: a calibration is valid, only its origin
// moves.
TEST(FindBoardPoints, TheWrongPatternOfEvenRowsMovesAllByASquare) {
  CharucoBoard board = charuco();
  board.rows = 6;
  board.is_legacy = true;
  const cv::Mat picture =
      tests::draw_board(tests::flat_picture(board), 640, 480, kTilted);
  board.is_legacy = false;
  auto points = points_in(picture, board);
  EXPECT_GE(points.size(), corner_count(board) / 2);
  for (PointDetection& point : points) {
    ASSERT_NE(point.point % (board.columns - 1), 0);
    --point.point;
  }
  EXPECT_LT(worst_px(points, board, kTilted), kExactPx);
}

TEST(FindBoardPoints, ABoardOfOtherColumnsIsNotThisOne) {
  CharucoBoard board = charuco();
  const cv::Mat picture =
      tests::draw_board(tests::flat_picture(board), 640, 480, kTilted);
  board.columns = 5;
  board.rows = 7;
  EXPECT_TRUE(points_in(picture, board).empty());
}

TEST(FindBoardPoints, TheOldPatternOfOddRowsIsTheNewOne) {
  CharucoBoard board = charuco();
  board.is_legacy = true;
  expect_exact(board, kTilted);
}

TEST(FindBoardPoints, FindsAnInvertedBoardWhenDeclared) {
  CharucoBoard board = charuco();
  board.is_inverted = true;
  expect_exact(board, kTilted);
}

TEST(FindBoardPoints, TheBackOfATwoSidedBoardHasTheFrontsNumbers) {
  CharucoBoard board = charuco();
  const BoardPlace mirrored{{kTilted[1], kTilted[0], kTilted[3], kTilted[2]}};
  EXPECT_TRUE(points_of(board, mirrored).empty());
  board.is_two_sided = true;
  expect_exact(board, mirrored);
  expect_exact(board, kTilted);
}

TEST(FindBoardPoints, FindsEveryCornerOfAChessboardTheRightWayUp) {
  expect_exact(chessboard(), kTilted);
  expect_exact(chessboard(), turned_half(kTilted));
  expect_exact(Chessboard{.rows = 9, .columns = 6, .square_size_m = 0.03},
               {{{200, 400}, {400, 420}, {430, 100}, {190, 130}}});
}

TEST(FindBoardPoints, FindsAChessboardInALargePicture) {
  const Chessboard board = chessboard();
  const BoardPlace place{{{600, 800}, {1300, 850}, {1250, 400}, {650, 380}}};
  const auto points =
      points_in(tests::draw_board(tests::flat_picture(board), 1920, 1080, place), board);
  ASSERT_EQ(points.size(), corner_count(board));
  EXPECT_LT(worst_px(points, board, place), kExactPx);
}

/// Returns the root mean square of a coordinate's error in sigmas, of all corners over
/// images with different noise.
template <class Board>
double error_in_sigmas(const Board& board, double noise) {
  const cv::Mat clean = tests::draw_board(tests::flat_picture(board), 640, 480, kTilted);
  double squares = 0.0;
  double count = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const cv::Mat picture = tests::disturbed(clean, 0.8, noise, seed);
    for (const PointDetection& point : points_in(picture, board)) {
      const glm::dvec2 error =
          point.pixel_px -
          tests::true_corner_px(board.rows, board.columns, point.point, kTilted);
      squares += glm::dot(error, error) / (point.sigma_px * point.sigma_px);
      count += 2.0;
    }
  }
  EXPECT_GT(count, 0.9 * 20.0 * static_cast<double>(corner_count(board)));
  return std::sqrt(squares / count);
}

// With pure noise, the sigma also contains 0.04 px of model error, so the errors are
// smaller than the sigma if noise is small.
TEST(FindBoardPoints, SigmaIsThatOfNoiseAndALittleMore) {
  for (const double noise : {2.0, 8.0}) {
    EXPECT_LT(error_in_sigmas(charuco(), noise), 1.05);
    EXPECT_LT(error_in_sigmas(chessboard(), noise), 1.05);
  }
  EXPECT_GT(error_in_sigmas(charuco(), 16.0), 0.4);
  EXPECT_GT(error_in_sigmas(chessboard(), 16.0), 0.4);
}

TEST(FindBoardPoints, HalfACharucoBoardGivesItsCorners) {
  const BoardPlace place{{{-180, 400}, {220, 430}, {260, 130}, {-150, 150}}};
  const auto points = points_of(charuco(), place);
  EXPECT_GE(points.size(), 8U);
  EXPECT_LT(points.size(), corner_count(charuco()));
  EXPECT_LT(worst_px(points, charuco(), place), kExactPx);
}

TEST(FindBoardPoints, LeavesOutCoveredPoints) {
  cv::Mat picture = tests::draw_board(tests::flat_picture(charuco()), 640, 480, kTilted);
  const glm::dvec2 covered = tests::true_corner_px(5, 7, 8, kTilted);
  const cv::Point middle(static_cast<int>(covered.x) + 3,
                         static_cast<int>(covered.y) + 3);
  picture(cv::Rect(middle - cv::Point(12, 4), cv::Size(24, 30))).setTo(120);
  const auto points = points_in(picture, charuco());
  EXPECT_GE(points.size(), corner_count(charuco()) - 4);
  for (const PointDetection& point : points) EXPECT_NE(point.point, 8);
  EXPECT_LT(worst_px(points, charuco(), kTilted), kExactPx);
}

TEST(FindBoardPoints, HalfAChessboardIsNone) {
  EXPECT_TRUE(
      points_of(chessboard(), {{{-180, 400}, {220, 430}, {260, 130}, {-150, 150}}})
          .empty());
}

TEST(FindBoardPoints, APictureWithoutTheBoardHasNoPoints) {
  const cv::Mat empty(480, 640, CV_8UC1, cv::Scalar(128));
  EXPECT_TRUE(points_in(empty, charuco()).empty());
  EXPECT_TRUE(points_in(empty, chessboard()).empty());
  const cv::Mat tiny(20, 20, CV_8UC1, cv::Scalar(128));
  EXPECT_TRUE(points_in(tiny, charuco()).empty());
  CharucoBoard other = charuco();
  other.dictionary = "DICT_4X4_50";
  const cv::Mat with_other =
      tests::draw_board(tests::flat_picture(other), 640, 480, kTilted);
  EXPECT_TRUE(points_in(with_other, charuco()).empty());
  EXPECT_TRUE(points_in(with_other, chessboard()).empty());
}

TEST(FindBoardPoints, DictionariesThatDoNotServeAreDeclined) {
  CharucoBoard board = charuco();
  board.dictionary = "DICT_5X5";
  const auto unknown = BoardFinder::create(board);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().cause.find("\"DICT_5X5\""), std::string::npos);
  board.dictionary = "DICT_4X4_50";
  board.rows = 20;
  const auto small = BoardFinder::create(board);
  ASSERT_FALSE(small);
  EXPECT_NE(small.error().cause.find("50 markers, of which 70"), std::string::npos);
}

}  // namespace
}  // namespace marey::capture
