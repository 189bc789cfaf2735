// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>

#include "capture/checker_corner.h"
#include "core/board.h"
#include "core/detection.h"

// Private to capture/: how each board of squares is searched for.
namespace marey::capture {

/// A corner of the board, and about where it is.
struct NumberedGuess {
  int point = 0;
  CheckerGuess guess;
};

/// A marker that was read.
struct ReadMarker {
  int id = 0;
  std::vector<cv::Point2f> corners_px;  ///< From its top left, clockwise when upright.
};

/// All markers of `dictionary` in `gray`, as they come.
[[nodiscard]] std::vector<ReadMarker> read_markers(
    const cv::Mat& gray, const cv::Ptr<cv::aruco::Dictionary>& dictionary);

/// Those of `markers` that lie on one plane as on the board. None when they are one alone,
/// or no more than half of those with an id of the board.
[[nodiscard]] std::vector<ReadMarker> markers_of_board(std::vector<ReadMarker> markers,
                                                       const CharucoBoard& board);

/// The corners next to markers of markers_of_board(), ascending.
[[nodiscard]] std::vector<NumberedGuess> charuco_guesses(
    const std::vector<ReadMarker>& markers, const CharucoBoard& board);

/// The grid of `columns` by `rows` inner corners of a chessboard, row after row from
/// either end; empty when it is not all there.
[[nodiscard]] std::vector<cv::Point2f> find_chess_grid(const cv::Mat& gray,
                                                       int rows,
                                                       int columns);

/// The corners of a chessboard, numbered so that the board is the right way up.
/// Precondition: `grid` is from find_chess_grid() for this board, not empty.
[[nodiscard]] std::vector<NumberedGuess> chessboard_guesses(
    const cv::Mat& gray, const std::vector<cv::Point2f>& grid, const Chessboard& board);

}  // namespace marey::capture
