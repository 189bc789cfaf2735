// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/boards/board_search.h"
#include "core/base/assert.h"

namespace marey::capture {
namespace {

/// The grid of a chessboard, row 0 next to the board's origin.
class Grid {
 public:
  Grid(const std::vector<cv::Point2f>& points, int rows, int columns)
      : rows_(rows), columns_(columns) {
    for (const cv::Point2f& p : points) points_.emplace_back(p.x, p.y);
  }

  [[nodiscard]] const glm::dvec2& at(int row, int column) const {
    return points_[static_cast<std::size_t>(row * columns_ + column)];
  }

  /// Returns the vector to the next corner along x; the mean of both sides if there are
  /// two.
  [[nodiscard]] glm::dvec2 along_x(int row, int column) const {
    const int left = std::max(column - 1, 0);
    const int right = std::min(column + 1, columns_ - 1);
    return (at(row, right) - at(row, left)) / static_cast<double>(right - left);
  }
  [[nodiscard]] glm::dvec2 along_y(int row, int column) const {
    const int below = std::max(row - 1, 0);
    const int above = std::min(row + 1, rows_ - 1);
    return (at(above, column) - at(below, column)) / static_cast<double>(above - below);
  }

  /// Only the front of the board is visible: y is to the left of x if y goes down the
  /// image.
  [[nodiscard]] bool is_mirrored() const {
    const glm::dvec2 x = at(0, columns_ - 1) - at(0, 0);
    const glm::dvec2 y = at(rows_ - 1, 0) - at(0, 0);
    return x.x * y.y - x.y * y.x > 0.0;
  }

  void turn_rows() {
    for (int row = 0; row < rows_ / 2; ++row) {
      for (int column = 0; column < columns_; ++column) {
        std::swap(
            points_[static_cast<std::size_t>(row * columns_ + column)],
            points_[static_cast<std::size_t>((rows_ - 1 - row) * columns_ + column)]);
      }
    }
  }
  void turn_half() { std::reverse(points_.begin(), points_.end()); }

  /// Returns the mean grey of the squares with the colour of the one at the origin, minus
  /// that of the others. The square beyond corner (0, 0), away from the origin, has the
  /// same colour as that at the origin.
  [[nodiscard]] double origin_less_others(const cv::Mat& gray) const {
    double sums[2] = {0.0, 0.0};
    double counts[2] = {0.0, 0.0};
    for (int row = 0; row + 1 < rows_; ++row) {
      for (int column = 0; column + 1 < columns_; ++column) {
        const glm::dvec2 middle = 0.25 * (at(row, column) + at(row, column + 1) +
                                          at(row + 1, column) + at(row + 1, column + 1));
        const int x =
            std::clamp(static_cast<int>(std::lround(middle.x)), 0, gray.cols - 1);
        const int y =
            std::clamp(static_cast<int>(std::lround(middle.y)), 0, gray.rows - 1);
        sums[(row + column) % 2] += gray.at<std::uint8_t>(y, x);
        counts[(row + column) % 2] += 1.0;
      }
    }
    return sums[0] / std::max(counts[0], 1.0) - sums[1] / std::max(counts[1], 1.0);
  }

 private:
  int rows_;
  int columns_;
  std::vector<glm::dvec2> points_;
};

}  // namespace

std::vector<cv::Point2f> find_chess_grid(const cv::Mat& gray, int rows, int columns) {
  constexpr int kFlags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE |
                         cv::CALIB_CB_FAST_CHECK;
  // Usable boards are large enough to be found in a reduced image. In a full image with
  // other squares, the search would take a second.
  constexpr double kSide = 800.0;
  const double scale = std::min(1.0, kSide / std::max(gray.cols, gray.rows));
  cv::Mat small = gray;
  if (scale < 1.0) cv::resize(gray, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<cv::Point2f> grid;
  if (!cv::findChessboardCorners(small, {columns, rows}, grid, kFlags)) return {};
  const double fx = static_cast<double>(gray.cols) / small.cols;
  const double fy = static_cast<double>(gray.rows) / small.rows;
  for (cv::Point2f& p : grid) {
    p = {static_cast<float>((static_cast<double>(p.x) + 0.5) * fx - 0.5),
         static_cast<float>((static_cast<double>(p.y) + 0.5) * fy - 0.5)};
  }
  return grid;
}

std::vector<NumberedGuess> chessboard_guesses(const cv::Mat& gray,
                                              const std::vector<cv::Point2f>& grid,
                                              const Chessboard& board) {
  const int rows = board.rows - 1;
  const int columns = board.columns - 1;
  MAREY_ASSERT(grid.size() == static_cast<std::size_t>(rows * columns));
  Grid points(grid, rows, columns);
  if (points.is_mirrored()) points.turn_rows();
  if (points.origin_less_others(gray) > 0.0) points.turn_half();
  const bool black_at_origin = points.origin_less_others(gray) < 0.0;
  std::vector<NumberedGuess> guesses;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      guesses.push_back({row * columns + column,
                         {points.at(row, column),
                          points.along_x(row, column),
                          points.along_y(row, column),
                          ((row + column) % 2 == 0) == black_at_origin,
                          0.5}});
    }
  }
  return guesses;
}

}  // namespace marey::capture
