// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_board.h"

#include <cstddef>
#include <sstream>
#include <utility>

#include "core/base/assert.h"
#include "recordings/base/toml_writer.h"
#include "recordings/print/print_marks.h"
#include "recordings/print/print_tiles.h"

namespace marey::recordings {
namespace {

constexpr double kRounding_m = 1e-9;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

void append(std::vector<PrintBox>& boxes, const std::vector<PrintBox>& more) {
  boxes.insert(boxes.end(), more.begin(), more.end());
}

BoardPicture picture_of(const AprilGrid& grid,
                        const TagFamilyShape& family,
                        std::span<const TagPattern> patterns) {
  const double cell = grid.tag_size_m / family.square_cells;
  const int outer_cells = family.white_square ? family.cells - family.square_cells : 0;
  // From the board's edge to the first square: the pattern's outer cells, and white.
  const double edge = (0.5 * outer_cells + 1.0) * cell;
  const double step = grid.tag_size_m + grid.gap_m;
  BoardPicture picture;
  picture.name = "the board";
  picture.width = 2.0 * edge + grid.columns * step - grid.gap_m;
  picture.height = 2.0 * edge + grid.rows * step - grid.gap_m;
  // The board's frame has y up, the picture y down.
  const glm::dvec2 origin{edge, picture.height - edge};
  for (int place = 0; place < grid.tag_count(); ++place) {
    const TagPattern& pattern = patterns[static_cast<std::size_t>(place)];
    const TagId id{grid.first_id + place};
    const glm::dvec3 top_left_in_board = *grid.corner_in_board(id, 3);
    const glm::dvec2 top_left =
        origin + glm::dvec2(top_left_in_board.x, -top_left_in_board.y);
    append(
        picture.black,
        black_boxes(pattern, top_left - glm::dvec2(pattern.margin_cells * cell), cell));
    const auto around = [&](double by) {
      return PrintBox{top_left.x - by,
                      top_left.y - by,
                      top_left.x + grid.tag_size_m + by,
                      top_left.y + grid.tag_size_m + by};
    };
    // Neighbours share a gap.
    picture.tags.push_back({id, around(0.0), around(0.5 * (outer_cells + 1) * cell)});
  }
  for (int i = 1; i < grid.columns; ++i) {
    picture.seams_x.push_back(edge + i * step - 0.5 * grid.gap_m);
  }
  for (int i = 1; i < grid.rows; ++i) {
    picture.seams_y.push_back(edge + i * step - 0.5 * grid.gap_m);
  }
  if (grid.columns > 1) {
    picture.above = {edge + grid.tag_size_m, edge + step, "gap_m " + mm_text(grid.gap_m)};
  }
  picture.below = {
      edge, edge + grid.tag_size_m, "tag_size_m " + mm_text(grid.tag_size_m)};
  picture.origin = origin;
  picture.origin_text = "origin: here, at tag " + std::to_string(grid.first_id);
  return picture;
}

/// Draws squares of `side`, black where `is_black(from_top, column)`, with a white
/// border.
template <class IsBlack>
BoardPicture squares_of(int rows,
                        int columns,
                        double side,
                        double edge,
                        double seam,
                        const IsBlack& is_black) {
  BoardPicture picture;
  picture.name = "the board";
  picture.width = columns * side + 2.0 * edge;
  picture.height = rows * side + 2.0 * edge;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (!is_black(row, column)) continue;
      const glm::dvec2 corner{edge + column * side, edge + row * side};
      picture.black.push_back({corner.x, corner.y, corner.x + side, corner.y + side});
    }
  }
  // Next to the squares' corners, not through them.
  for (int i = 1; i < columns; ++i) picture.seams_x.push_back(edge + i * side + seam);
  for (int i = 1; i < rows; ++i) picture.seams_y.push_back(edge + i * side + seam);
  picture.below = {edge, edge + side, "square_size_m " + mm_text(side)};
  picture.origin = glm::dvec2(edge, picture.height - edge);
  picture.origin_text = "origin: here";
  return picture;
}

BoardPicture picture_of(const CharucoBoard& board, std::span<const TagPattern> patterns) {
  const double side = board.square_size_m;
  const double inset = 0.5 * (side - board.marker_size_m);
  // A white border separates black squares from the background; seams are next to the
  // markers.
  const double edge = inset;
  const auto is_white = [&](int from_top, int column) {
    return board.is_white(board.rows - 1 - from_top, column);
  };
  BoardPicture picture = squares_of(
      board.rows, board.columns, side, edge, 0.5 * inset, [&](int row, int column) {
        return !is_white(row, column);
      });
  std::size_t next = 0;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if (!is_white(row, column)) continue;
      const glm::dvec2 corner{edge + column * side, edge + row * side};
      const TagPattern& pattern = patterns[next];
      const glm::dvec2 marker = corner + glm::dvec2(inset);
      const double size = board.marker_size_m;
      append(picture.black, black_boxes(pattern, marker, size / pattern.cells));
      picture.tags.push_back({TagId{static_cast<int>(next)},
                              {marker.x, marker.y, marker.x + size, marker.y + size},
                              {corner.x, corner.y, corner.x + side, corner.y + side}});
      ++next;
    }
  }
  const PrintBox& marker = picture.tags.front().square;
  picture.above = {
      marker.left, marker.right, "marker_size_m " + mm_text(board.marker_size_m)};
  return picture;
}

PrintFrame frame_of(const AprilGrid& grid, const TagFamilyShape& family) {
  PrintFrame frame;
  frame.title = "AprilGrid " + std::to_string(grid.columns) + " x " +
                std::to_string(grid.rows) + ", " + family.name + " " +
                std::to_string(grid.first_id) + " to " +
                std::to_string(grid.first_id + grid.tag_count() - 1);
  frame.how_to =
      "Glue it to a plate that is flat and stiff, without bubbles, and copy the table "
      "below into session.toml; thickness_m is the plate's. ";
  frame.how_to += family.white_square
                      ? "tag_size_m is the edge of the white square inside a black ring."
                      : "tag_size_m is the edge of a black square.";
  frame.table = lines_of(board_table(grid, family.name));
  return frame;
}

constexpr const char* kGlueIt =
    "Glue it to a plate that is flat and stiff, and copy the table below into "
    "session.toml.";

std::string squares_text(int columns, int rows) {
  return std::to_string(columns) + " x " + std::to_string(rows) + " squares";
}

PrintFrame frame_of(const CharucoBoard& board) {
  PrintFrame frame;
  frame.title =
      "ChArUco " + squares_text(board.columns, board.rows) + ", " + board.dictionary;
  frame.how_to = kGlueIt;
  if (board.rows % 2 == 0) {
    frame.how_to +=
        board.is_legacy
            ? " Its pattern is that of OpenCV before 4.6."
            : " OpenCV before 4.6 needs another pattern for an even number of "
              "rows.";
  }
  frame.table = lines_of(board_table(board));
  return frame;
}

PrintFrame frame_of(const Chessboard& board) {
  PrintFrame frame;
  frame.title = "Chessboard " + squares_text(board.columns, board.rows);
  frame.how_to = kGlueIt;
  frame.table = lines_of(board_table(board));
  return frame;
}

/// TomlWriter begins with an empty line.
std::string without_blank(std::string text) {
  text.erase(0, text.find_first_not_of('\n'));
  return text;
}

}  // namespace

std::string board_table(const AprilGrid& grid, const std::string& family) {
  TomlWriter writer;
  writer.table({"board"});
  writer.text("type", "aprilgrid");
  writer.text("family", family);
  writer.integer("rows", grid.rows);
  writer.integer("columns", grid.columns);
  writer.number("tag_size_m", grid.tag_size_m);
  writer.number("gap_m", grid.gap_m);
  writer.integer("first_id", grid.first_id);
  writer.number("thickness_m", grid.thickness_m);
  return without_blank(writer.str());
}

std::string board_table(const CharucoBoard& board) {
  TomlWriter writer;
  writer.table({"board"});
  writer.text("type", "charuco");
  writer.integer("rows", board.rows);
  writer.integer("columns", board.columns);
  writer.number("square_size_m", board.square_size_m);
  writer.number("marker_size_m", board.marker_size_m);
  writer.text("dictionary", board.dictionary);
  if (board.is_legacy) writer.boolean("legacy", true);
  if (board.is_inverted) writer.boolean("inverted", true);
  if (board.is_two_sided) writer.boolean("two_sided", true);
  if (board.thickness_m > 0.0) writer.number("thickness_m", board.thickness_m);
  return without_blank(writer.str());
}

std::string board_table(const Chessboard& board) {
  TomlWriter writer;
  writer.table({"board"});
  writer.text("type", "chessboard");
  writer.integer("rows", board.rows);
  writer.integer("columns", board.columns);
  writer.number("square_size_m", board.square_size_m);
  if (board.thickness_m > 0.0) writer.number("thickness_m", board.thickness_m);
  return without_blank(writer.str());
}

Result<PrintedDocument> lay_out_board(const AprilGrid& grid,
                                      const TagFamilyShape& family,
                                      std::span<const TagPattern> patterns,
                                      const BoardPages& pages) {
  MAREY_ASSERT(grid.rows > 0 && grid.columns > 0 &&
               patterns.size() == static_cast<std::size_t>(grid.tag_count()));
  const double cell = grid.tag_size_m / family.square_cells;
  const int outer_cells = family.white_square ? family.cells - family.square_cells : 0;
  const double min_gap = (outer_cells + 1) * cell;
  if (grid.gap_m < min_gap - kRounding_m) {
    return bad_input(
        "gap",
        mm_text(grid.gap_m) + " between tags of " + mm_text(grid.tag_size_m) +
            " is too little for " + family.name,
        "use at least " + mm_text(min_gap) + ": each tag needs a white border");
  }
  return tile(picture_of(grid, family, patterns), frame_of(grid, family), pages);
}

Result<PrintedDocument> lay_out_board(const CharucoBoard& board,
                                      std::span<const TagPattern> patterns,
                                      const BoardPages& pages) {
  MAREY_ASSERT(board.rows > 1 && board.columns > 1 &&
               patterns.size() == static_cast<std::size_t>(board.marker_count()));
  if (board.is_inverted || board.is_two_sided) {
    return bad_input("board",
                     "boards of white on black, or with two sides, are not printed",
                     "leave out inverted and two_sided, or print it with the program "
                     "that made it");
  }
  const double cell = board.marker_size_m / patterns.front().cells;
  const double min_white = 0.5 * cell;
  if (0.5 * (board.square_size_m - board.marker_size_m) < min_white - kRounding_m) {
    return bad_input(
        "marker",
        "markers of " + mm_text(board.marker_size_m) +
            " leave too little white in squares of " + mm_text(board.square_size_m),
        "use --marker-size " +
            mm_text(board.square_size_m / (1.0 + 1.0 / patterns.front().cells)) +
            " or less");
  }
  return tile(picture_of(board, patterns), frame_of(board), pages);
}

Result<PrintedDocument> lay_out_board(const Chessboard& board, const BoardPages& pages) {
  MAREY_ASSERT(board.rows > 1 && board.columns > 1);
  if ((board.rows + board.columns) % 2 == 0) {
    return bad_input("board",
                     "a chessboard of " + squares_text(board.columns, board.rows) +
                         " looks the same after half a turn: no two cameras could agree "
                         "on it",
                     "take one row or column more, or a board of another type");
  }
  const double side = board.square_size_m;
  return tile(squares_of(board.rows,
                         board.columns,
                         side,
                         0.5 * side,
                         0.2 * side,
                         [&](int from_top, int column) {
                           return (board.rows - 1 - from_top + column) % 2 == 0;
                         }),
              frame_of(board),
              pages);
}

}  // namespace marey::recordings
