// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/boards/board_search.h"

namespace marey::capture {
namespace {

/// A square of the board; row 0 is at the origin.
struct Square {
  int row = 0;
  int column = 0;
};

/// Returns the square of each marker, by its id.
std::vector<Square> squares_of_markers(const CharucoBoard& board) {
  std::vector<Square> squares;
  for (int row = board.rows - 1; row >= 0; --row) {
    for (int column = 0; column < board.columns; ++column) {
      if (board.is_white(row, column)) squares.push_back({row, column});
    }
  }
  return squares;
}

/// Returns the distance from the edge of a square to its marker. In squares.
double inset(const CharucoBoard& board) {
  return 0.5 * (1.0 - board.marker_size_m / board.square_size_m);
}

/// Returns the corners of a marker on the board, in the order of ReadMarker. In squares.
std::array<cv::Point2f, 4> marker_on_board(const Square& square,
                                           const CharucoBoard& board) {
  const auto low = static_cast<float>(inset(board));
  const float high = 1.0F - low;
  const cv::Point2f corner(static_cast<float>(square.column),
                           static_cast<float>(square.row));
  return {corner + cv::Point2f(low, high),
          corner + cv::Point2f(high, high),
          corner + cv::Point2f(high, low),
          corner + cv::Point2f(low, low)};
}

glm::dvec2 apply(const cv::Matx33d& homography, double x, double y) {
  const cv::Vec3d p = homography * cv::Vec3d(x, y, 1.0);
  return {p[0] / p[2], p[1] / p[2]};
}

cv::Matx33d image_from_board(const ReadMarker& marker,
                             const Square& square,
                             const CharucoBoard& board) {
  const std::array<cv::Point2f, 4> from = marker_on_board(square, board);
  return cv::Matx33d(static_cast<cv::Matx33d>(
      cv::getPerspectiveTransform(from.data(), marker.corners_px.data())));
}

double side_px(const ReadMarker& marker) {
  return std::sqrt(std::abs(cv::contourArea(marker.corners_px)));
}

/// Returns true if the marker is not mirrored: its corners have the same sense of
/// rotation as on paper.
bool is_seen_from_the_front(const ReadMarker& marker) {
  return cv::contourArea(marker.corners_px, /*oriented=*/true) > 0.0;
}

}  // namespace

std::vector<ReadMarker> markers_of_board(std::vector<ReadMarker> markers,
                                         const CharucoBoard& board) {
  const std::vector<Square> squares = squares_of_markers(board);
  std::erase_if(markers, [&](const ReadMarker& marker) {
    return marker.id < 0 || static_cast<std::size_t>(marker.id) >= squares.size() ||
           !is_seen_from_the_front(marker);
  });
  if (markers.size() < 2) return {};
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  double mean_side_px = 0.0;
  for (const ReadMarker& marker : markers) {
    const auto corners =
        marker_on_board(squares[static_cast<std::size_t>(marker.id)], board);
    from.insert(from.end(), corners.begin(), corners.end());
    to.insert(to.end(), marker.corners_px.begin(), marker.corners_px.end());
    mean_side_px += side_px(marker) / static_cast<double>(markers.size());
  }
  // Lens distortion bends a board by this amount, or more if it fills the image.
  const double near_px = std::max(2.5, 0.12 * mean_side_px);
  std::vector<std::uint8_t> fits;
  const cv::Mat found = cv::findHomography(from, to, cv::RANSAC, near_px, fits);
  if (found.empty()) return {};
  std::vector<ReadMarker> kept;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const auto* first = fits.data() + 4 * i;
    const bool all =
        std::all_of(first, first + 4, [](std::uint8_t fit) { return fit != 0; });
    const bool known =
        std::any_of(kept.begin(), kept.end(), [&](const ReadMarker& other) {
          return other.id == markers[i].id;
        });
    if (all && !known) kept.push_back(std::move(markers[i]));
  }
  // If most do not fit, the board is another one of the same dictionary.
  if (kept.size() < 2 || 2 * kept.size() <= markers.size()) return {};
  return kept;
}

std::vector<NumberedGuess> charuco_guesses(const std::vector<ReadMarker>& markers,
                                           const CharucoBoard& board) {
  struct Sum {
    glm::dvec2 at{0.0};
    glm::dvec2 x{0.0};
    glm::dvec2 y{0.0};
    double count = 0.0;
  };
  std::map<int, Sum> sums;
  const std::vector<Square> squares = squares_of_markers(board);
  for (const ReadMarker& marker : markers) {
    const Square& square = squares[static_cast<std::size_t>(marker.id)];
    const cv::Matx33d homography = image_from_board(marker, square, board);
    for (const int up : {0, 1}) {
      for (const int right : {0, 1}) {
        const int row = square.row + up;
        const int column = square.column + right;
        if (row < 1 || column < 1 || row >= board.rows || column >= board.columns)
          continue;
        const double x = column;
        const double y = row;
        Sum& sum = sums[(row - 1) * (board.columns - 1) + column - 1];
        sum.at += apply(homography, x, y);
        sum.x += apply(homography, x + 0.5, y) - apply(homography, x - 0.5, y);
        sum.y += apply(homography, x, y + 0.5) - apply(homography, x, y - 0.5);
        sum.count += 1.0;
      }
    }
  }
  std::vector<NumberedGuess> guesses;
  for (const auto& [point, sum] : sums) {
    const int row = point / (board.columns - 1);
    const int column = point % (board.columns - 1);
    guesses.push_back({point,
                       {sum.at / sum.count,
                        sum.x / sum.count,
                        sum.y / sum.count,
                        !board.is_white(row, column),
                        inset(board)}});
  }
  return guesses;
}

}  // namespace marey::capture
