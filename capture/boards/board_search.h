// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "capture/boards/checker_corner.h"
#include "capture/boards/read_markers.h"
#include "core/board.h"
#include "core/detection.h"

// Private to capture: search functions per kind of board of squares.
namespace marey::capture {

/// A numbered corner of the board and its approximate pixel.
struct NumberedGuess {
  int point = 0;
  CheckerGuess guess;
};

/// Returns the markers that fit the board's layout on one plane. Returns none if only one
/// fits, or at most half of those with an id of the board.
[[nodiscard]] std::vector<ReadMarker> markers_of_board(std::vector<ReadMarker> markers,
                                                       const CharucoBoard& board);

/// Returns the corners next to markers of markers_of_board(), ascending.
[[nodiscard]] std::vector<NumberedGuess> charuco_guesses(
    const std::vector<ReadMarker>& markers, const CharucoBoard& board);

/// Returns the grid of `columns` by `rows` inner corners of a chessboard, row by row from
/// either end; empty if it is incomplete.
[[nodiscard]] std::vector<cv::Point2f> find_chess_grid(const cv::Mat& gray,
                                                       int rows,
                                                       int columns);

/// Returns the corners of a chessboard, numbered for the upright board. Precondition:
/// `grid` is from find_chess_grid() for this board, not empty.
[[nodiscard]] std::vector<NumberedGuess> chessboard_guesses(
    const cv::Mat& gray, const std::vector<cv::Point2f>& grid, const Chessboard& board);

}  // namespace marey::capture
