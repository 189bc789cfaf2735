// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/assert.h"
#include "core/base/ids.h"

namespace marey {

/// A flat calibration board of tags in a grid (Kalibr's AprilGrid, with or without its
/// corner squares, which marey does not use).
///
/// Board frame: origin at the bottom left corner of the first tag's black square, x along
/// its row, y up the rows, z out of the printed face. Ids grow along x, then along y.
struct AprilGrid {
  int rows = 6;
  int columns = 6;
  double tag_size_m = 0.1;  ///< Edge of a black square.
  double gap_m = 0.03;      ///< Between two black squares.
  int first_id = 0;
  /// Thickness of the plate: height of its face above the floor.
  double thickness_m = 0.0;

  [[nodiscard]] int tag_count() const { return rows * columns; }

  [[nodiscard]] bool contains(TagId id) const {
    return number(id) >= first_id && number(id) < first_id + tag_count();
  }

  /// Returns corner `corner` (0..3, the order of TagDetection::corners_px) of tag `id`,
  /// in the board's frame. [m] nullopt when the tag is not on this board.
  /// Precondition: 0 <= corner < 4.
  [[nodiscard]] std::optional<glm::dvec3> corner_in_board(TagId id, int corner) const {
    MAREY_ASSERT(corner >= 0 && corner < 4);
    if (!contains(id)) return std::nullopt;
    const int place = number(id) - first_id;
    const int column = place % columns;
    const int row = place / columns;
    const double x = column * (tag_size_m + gap_m);
    const double y = row * (tag_size_m + gap_m);
    // Bottom left, bottom right, top right, top left.
    return glm::dvec3(x + (corner == 1 || corner == 2 ? tag_size_m : 0.0),
                      y + (corner >= 2 ? tag_size_m : 0.0),
                      0.0);
  }
};

/// A flat chessboard with a marker in every white square. Its inner corners are detected.
///
/// Board frame: origin at the bottom left corner of the outermost square, x to the right,
/// y up, z out of the printed face, when the markers stand upright.
struct CharucoBoard {
  int rows = 5;     ///< Squares, not corners.
  int columns = 7;  ///< Squares, not corners.
  double square_size_m = 0.04;
  double marker_size_m = 0.03;             ///< Edge of a marker's black square.
  std::string dictionary = "DICT_4X4_50";  ///< Name in OpenCV.
  /// Boards of even rows start with a white square at the top left, as OpenCV drew them
  /// before version 4.6.
  bool is_legacy = false;
  /// White and black are exchanged, also in the markers.
  bool is_inverted = false;
  /// Its back shows it mirrored, each corner behind that of the front; the plate is thin.
  /// So cameras on both sides see the same points.
  bool is_two_sided = false;
  double thickness_m = 0.0;  ///< As AprilGrid's.

  /// Number of markers, one in every square that is not black: ids from 0 along the rows,
  /// from the top left.
  [[nodiscard]] int marker_count() const { return rows * columns / 2; }

  /// True if a square is white, that is, has a marker; row 0 is at the origin.
  [[nodiscard]] bool is_white(int row, int column) const {
    const int from_top = rows - 1 - row;
    const bool starts_white = is_legacy && rows % 2 == 0;
    return ((from_top + column) % 2 == 0) == starts_white;
  }
};

/// A flat chessboard. Board frame as CharucoBoard's, the right way up when the corner
/// square at the origin is black; a board whose rows and columns are both even or both
/// odd looks the same after half a turn, and cannot be used with several cameras.
struct Chessboard {
  int rows = 7;      ///< Squares, not corners.
  int columns = 10;  ///< Squares, not corners.
  double square_size_m = 0.03;
  double thickness_m = 0.0;  ///< As AprilGrid's.
};

/// A rigid body with tags of known size; their places on it are estimated when it is
/// used. Its frame is that of the detected tag with the lowest id.
struct Wand {
  struct Tag {
    TagId id{};
    double size_m = 0.1;  ///< Edge of its black square.
  };
  std::vector<Tag> tags;  ///< Ascending ids, at least one.
};

/// Target for the calibration of cameras.
using CalibrationTarget = std::variant<AprilGrid, CharucoBoard, Chessboard, Wand>;

/// Returns true if the target is detected as PointDetections: a board of squares.
[[nodiscard]] inline bool has_points(const CalibrationTarget& target) {
  return std::holds_alternative<CharucoBoard>(target) ||
         std::holds_alternative<Chessboard>(target);
}

/// Returns the target's name in messages: "ChArUco board of 4 x 5 squares
/// (DICT_4X4_1000)", its columns first.
[[nodiscard]] inline std::string name_of(const CalibrationTarget& target) {
  const auto by = [](int columns, int rows) {
    return std::to_string(columns) + " x " + std::to_string(rows);
  };
  if (const auto* grid = std::get_if<AprilGrid>(&target)) {
    return "AprilGrid of " + by(grid->columns, grid->rows) + " tags";
  }
  if (const auto* charuco = std::get_if<CharucoBoard>(&target)) {
    return "ChArUco board of " + by(charuco->columns, charuco->rows) + " squares (" +
           charuco->dictionary + ")";
  }
  if (const auto* chess = std::get_if<Chessboard>(&target)) {
    return "chessboard of " + by(chess->columns, chess->rows) + " squares";
  }
  return "wand of " + std::to_string(std::get<Wand>(target).tags.size()) + " tags";
}

/// Returns inner corner `point` of a board of squares, in its frame [m]: 0 is next to the
/// origin, numbers grow along x, then along y. nullopt when the board has no such corner.
[[nodiscard]] inline std::optional<glm::dvec3> inner_corner_in_board(int rows,
                                                                     int columns,
                                                                     double square_size_m,
                                                                     int point) {
  if (point < 0 || point >= (rows - 1) * (columns - 1)) return std::nullopt;
  const int column = point % (columns - 1);
  const int row = point / (columns - 1);
  return glm::dvec3((column + 1) * square_size_m, (row + 1) * square_size_m, 0.0);
}

}  // namespace marey
