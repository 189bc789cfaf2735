// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "capture/frame_source.h"
#include "core/board.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::capture {

/// Finds the inner corners of a board of squares in images. Has buffers of its own; one
/// thread at a time may use it.
class BoardFinder {
 public:
  /// Errors (kBadInput): the dictionary is not known, or has too few markers. A
  /// chessboard that looks the same after half a turn is taken as it first comes.
  /// Precondition: at least three squares one way and two the other.
  [[nodiscard]] static Result<BoardFinder> create(const CharucoBoard& board);
  [[nodiscard]] static Result<BoardFinder> create(const Chessboard& board);

  BoardFinder(BoardFinder&&) noexcept;
  BoardFinder& operator=(BoardFinder&&) noexcept;
  ~BoardFinder();

  /// Corners of the board in `frame`, numbered as inner_corner_in_board() says,
  /// ascending, each placed as capture/checker_corner.h says.
  ///
  /// Of a ChArUco board any part will do that shows two markers and lies flat: corners
  /// next to a marker that was read. A chessboard must be all there; which way up it is,
  /// its black corner square tells. The back of a board with two sides is looked for
  /// where the front is not seen. No board, or too little of it: empty. Same image, same
  /// answer; nothing is remembered. At 1280x720 about 20 ms for a ChArUco board, and
  /// for a chessboard, whose squares must be 16 px wide there or more; several times that
  /// where other squares are seen in its place.
  [[nodiscard]] std::vector<PointDetection> find(const GrayFrame& frame);

 private:
  struct Impl;
  explicit BoardFinder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
