// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "capture/video/frame_source.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::capture {

/// Finds the inner corners of a board of squares in images. Owns its buffers; one thread
/// at a time may use it.
class BoardFinder {
 public:
  /// Errors (kBadInput): the dictionary is not known, or has too few markers. If a
  /// chessboard looks the same after half a turn, the first orientation found is used.
  /// Precondition: at least three squares in one direction and two in the other.
  [[nodiscard]] static Result<BoardFinder> create(const CharucoBoard& board);
  [[nodiscard]] static Result<BoardFinder> create(const Chessboard& board);

  BoardFinder(BoardFinder&&) noexcept;
  BoardFinder& operator=(BoardFinder&&) noexcept;
  ~BoardFinder();

  /// Returns the corners of the board in `frame`, numbered as in inner_corner_in_board(),
  /// ascending, refined by find_checker_corner() (capture/boards/checker_corner.h).
  ///
  /// For a ChArUco board, any flat part with two visible markers is sufficient: corners
  /// next to a detected marker are returned. A chessboard must be completely visible; its
  /// black corner square determines its orientation. The back of a two-sided board is
  /// searched for if the front is not seen. Returns none without a board or with too
  /// little of it. Stateless: equal images give equal results. Cost at 1280x720: about 20
  /// ms for a ChArUco board or a chessboard (whose squares must be at least 16 px wide
  /// there); several times that if other squares are in view instead.
  [[nodiscard]] std::vector<PointDetection> find(const GrayFrame& frame);

 private:
  struct Impl;
  explicit BoardFinder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
