// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/boards/find_board_points.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include "capture/boards/board_search.h"
#include "capture/tags/aruco_dictionary.h"
#include "capture/video/read_image.h"
#include "core/base/assert.h"

namespace marey::capture {

struct BoardFinder::Impl {
  std::variant<CharucoBoard, Chessboard> board;
  std::optional<MarkerReader> markers;  ///< For ChArUco: those on the board.
  cv::Mat inverted{};
  cv::Mat mirrored{};

  [[nodiscard]] std::vector<NumberedGuess> guesses(const cv::Mat& gray);
  [[nodiscard]] std::vector<PointDetection> find_front(const cv::Mat& gray);
  [[nodiscard]] std::vector<PointDetection> find(const GrayFrame& frame);
};

std::vector<NumberedGuess> BoardFinder::Impl::guesses(const cv::Mat& gray) {
  if (const auto* charuco = std::get_if<CharucoBoard>(&board)) {
    return charuco_guesses(markers_of_board(markers->read(gray), *charuco), *charuco);
  }
  const auto& chess = std::get<Chessboard>(board);
  const auto grid = find_chess_grid(gray, chess.rows - 1, chess.columns - 1);
  if (grid.empty()) return {};
  return chessboard_guesses(gray, grid, chess);
}

std::vector<PointDetection> BoardFinder::Impl::find_front(const cv::Mat& gray) {
  // One or two corners of a board are probably a false detection.
  constexpr std::size_t kMinPoints = 4;
  const GrayFrame frame = view_of(gray, 0);
  std::vector<PointDetection> points;
  for (const NumberedGuess& one : guesses(gray)) {
    const auto corner = find_checker_corner(frame, one.guess);
    if (corner) points.push_back({one.point, corner->pixel_px, corner->sigma_px});
  }
  if (points.size() < kMinPoints) points.clear();
  return points;
}

std::vector<PointDetection> BoardFinder::Impl::find(const GrayFrame& frame) {
  // OpenCV only reads it.
  cv::Mat gray(frame.height_px,
               frame.width_px,
               CV_8UC1,
               const_cast<std::uint8_t*>(frame.pixels),
               static_cast<std::size_t>(frame.stride));
  const auto* charuco = std::get_if<CharucoBoard>(&board);
  if (charuco != nullptr && charuco->is_inverted) {
    cv::bitwise_not(gray, inverted);
    gray = inverted;
  }
  std::vector<PointDetection> points = find_front(gray);
  if (!points.empty() || charuco == nullptr || !charuco->is_two_sided) return points;
  constexpr int kLeftToRight = 1;
  cv::flip(gray, mirrored, kLeftToRight);
  points = find_front(mirrored);
  for (PointDetection& point : points) {
    point.pixel_px.x = frame.width_px - 1.0 - point.pixel_px.x;
  }
  return points;
}

BoardFinder::BoardFinder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BoardFinder::BoardFinder(BoardFinder&&) noexcept = default;
BoardFinder& BoardFinder::operator=(BoardFinder&&) noexcept = default;
BoardFinder::~BoardFinder() = default;

Result<BoardFinder> BoardFinder::create(const CharucoBoard& board) {
  MAREY_ASSERT(std::min(board.rows, board.columns) > 1 &&
               std::max(board.rows, board.columns) > 2);
  auto markers = aruco_dictionary(board.dictionary, board.marker_count());
  if (!markers) return markers.error();
  // Only the board's markers: fewer false detections.
  markers->codes.resize(static_cast<std::size_t>(board.marker_count()));
  return BoardFinder(std::make_unique<Impl>(Impl{board, MarkerReader(*markers)}));
}

Result<BoardFinder> BoardFinder::create(const Chessboard& board) {
  MAREY_ASSERT(std::min(board.rows, board.columns) > 1 &&
               std::max(board.rows, board.columns) > 2);
  return BoardFinder(std::make_unique<Impl>(Impl{board, std::nullopt}));
}

std::vector<PointDetection> BoardFinder::find(const GrayFrame& frame) {
  MAREY_ASSERT(frame.pixels != nullptr && frame.stride >= frame.width_px);
  constexpr int kMinSide = 32;
  if (std::min(frame.width_px, frame.height_px) < kMinSide) return {};
  try {
    return impl_->find(frame);
  } catch (const cv::Exception&) {
    return {};  // An image that OpenCV cannot process shows no board.
  }
}

}  // namespace marey::capture
