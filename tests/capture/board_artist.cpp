// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/board_artist.h"

#include <stdexcept>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

namespace marey::tests {
namespace {

constexpr int kSquare = 60;  // Pixels of the flat image.
constexpr int kFiner = 6;    // Resolution of the drawing relative to the image.

cv::Ptr<cv::aruco::Dictionary> dictionary_of(const CharucoBoard& board) {
  if (board.dictionary == "DICT_5X5_100") {
    return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
  }
  if (board.dictionary == "DICT_4X4_50") {
    return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  }
  if (board.dictionary == "DICT_APRILTAG_36h11") {
    return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
  }
  throw std::invalid_argument("no such dictionary: " + board.dictionary);
}

cv::Mat white_paper(int rows, int columns) {
  return {(rows + 2) * kSquare, (columns + 2) * kSquare, CV_8UC1, cv::Scalar(255)};
}

cv::Rect square_at(int from_top, int column) {
  return {(column + 1) * kSquare, (from_top + 1) * kSquare, kSquare, kSquare};
}

/// As drawn by OpenCV before 4.6: the square at the bottom left is black.
void draw_old_pattern(const CharucoBoard& board, cv::Mat& flat) {
  const int side =
      static_cast<int>(std::lround(kSquare * board.marker_size_m / board.square_size_m));
  int id = 0;
  for (int from_top = 0; from_top < board.rows; ++from_top) {
    for (int column = 0; column < board.columns; ++column) {
      cv::Mat square = flat(square_at(from_top, column));
      if ((board.rows - 1 - from_top + column) % 2 == 0) {
        square.setTo(0);
        continue;
      }
      cv::Mat marker;
      dictionary_of(board)->drawMarker(id++, side, marker);
      const int inset = (kSquare - side) / 2;
      marker.copyTo(square(cv::Rect(inset, inset, side, side)));
    }
  }
}

/// Returns the homography from squares of the board, y up from its bottom left corner, to
/// the image.
cv::Mat picture_from_squares(int rows, int columns, const BoardPlace& place) {
  const auto w = static_cast<float>(columns);
  const auto h = static_cast<float>(rows);
  const std::array<cv::Point2f, 4> from{{{0, 0}, {w, 0}, {w, h}, {0, h}}};
  std::array<cv::Point2f, 4> to;
  for (std::size_t i = 0; i < 4; ++i) {
    to[i] = {static_cast<float>(place[i].x), static_cast<float>(place[i].y)};
  }
  return cv::getPerspectiveTransform(from.data(), to.data());
}

}  // namespace

cv::Mat flat_picture(const CharucoBoard& board) {
  cv::Mat flat = white_paper(board.rows, board.columns);
  if (board.is_legacy) {
    draw_old_pattern(board, flat);
  } else {
    const auto drawn =
        cv::aruco::CharucoBoard::create(board.columns,
                                        board.rows,
                                        static_cast<float>(board.square_size_m),
                                        static_cast<float>(board.marker_size_m),
                                        dictionary_of(board));
    cv::Mat inside =
        flat(cv::Rect(kSquare, kSquare, board.columns * kSquare, board.rows * kSquare));
    cv::Mat picture;
    drawn->draw(inside.size(), picture);
    picture.copyTo(inside);
  }
  if (board.is_inverted) cv::bitwise_not(flat, flat);
  return flat;
}

cv::Mat flat_picture(const Chessboard& board) {
  cv::Mat flat = white_paper(board.rows, board.columns);
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if ((row + column) % 2 == 0) {
        flat(square_at(board.rows - 1 - row, column)).setTo(0);
      }
    }
  }
  return flat;
}

cv::Mat draw_board(const cv::Mat& flat,
                   int width_px,
                   int height_px,
                   const BoardPlace& place) {
  const int rows = flat.rows / kSquare - 2;
  const int columns = flat.cols / kSquare - 2;
  // Pixel centres are at integers, in the flat image and in both others.
  const double s = 1.0 / kSquare;
  const cv::Matx33d squares_from_flat(
      s, 0, 0.5 * s - 1.0, 0, -s, rows + 1.0 - 0.5 * s, 0, 0, 1);
  const double f = kFiner;
  const cv::Matx33d fine_from_picture(f, 0, 0.5 * f - 0.5, 0, f, 0.5 * f - 0.5, 0, 0, 1);
  const cv::Matx33d squares_to_picture = picture_from_squares(rows, columns, place);
  const cv::Mat fine_from_flat(fine_from_picture * squares_to_picture *
                               squares_from_flat);
  cv::Mat fine(height_px * kFiner, width_px * kFiner, CV_8UC1);
  cv::warpPerspective(flat,
                      fine,
                      fine_from_flat,
                      fine.size(),
                      cv::INTER_LINEAR,
                      cv::BORDER_CONSTANT,
                      cv::Scalar(150));
  cv::Mat picture;
  cv::resize(fine, picture, {width_px, height_px}, 0, 0, cv::INTER_AREA);
  // Cameras see black and white with a reduced contrast.
  picture.convertTo(picture, CV_8U, 180.0 / 255.0, 30.0);
  return picture;
}

glm::dvec2 true_corner_px(int rows, int columns, int point, const BoardPlace& place) {
  const auto p_in_board = inner_corner_in_board(rows, columns, 1.0, point);
  const cv::Matx33d homography = picture_from_squares(rows, columns, place);
  const cv::Vec3d p = homography * cv::Vec3d(p_in_board->x, p_in_board->y, 1.0);
  return {p[0] / p[2], p[1] / p[2]};
}

}  // namespace marey::tests
