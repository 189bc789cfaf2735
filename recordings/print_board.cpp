// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print_board.h"

#include <cstddef>
#include <sstream>
#include <utility>

#include "core/assert.h"
#include "recordings/print_marks.h"
#include "recordings/print_tiles.h"
#include "recordings/toml_writer.h"

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
  // From the board's edge to the first square: what is printed outside of it, and white.
  const double edge = (0.5 * outer_cells + 1.0) * cell;
  const double step = grid.tag_size_m + grid.gap_m;
  BoardPicture picture;
  picture.name = "the board";
  picture.width = 2.0 * edge + grid.columns * step - grid.gap_m;
  picture.height = 2.0 * edge + grid.rows * step - grid.gap_m;
  // The board's frame has y up, the picture down.
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

BoardPicture picture_of(const CharucoBoard& board, std::span<const TagPattern> patterns) {
  // White around, where black squares would meet whatever lies behind.
  const double edge = 0.5 * (board.square_m - board.marker_m);
  const double inset = 0.5 * (board.square_m - board.marker_m);
  BoardPicture picture;
  picture.name = "the board";
  picture.width = board.squares_x * board.square_m + 2.0 * edge;
  picture.height = board.squares_y * board.square_m + 2.0 * edge;
  std::size_t next = 0;
  for (int row = 0; row < board.squares_y; ++row) {
    for (int column = 0; column < board.squares_x; ++column) {
      const glm::dvec2 corner{edge + column * board.square_m,
                              edge + row * board.square_m};
      if (row % 2 == column % 2) {
        picture.black.push_back(
            {corner.x, corner.y, corner.x + board.square_m, corner.y + board.square_m});
        continue;
      }
      const TagPattern& pattern = patterns[next];
      const glm::dvec2 marker = corner + glm::dvec2(inset);
      append(picture.black, black_boxes(pattern, marker, board.marker_m / pattern.cells));
      picture.tags.push_back(
          {TagId{static_cast<int>(next)},
           {marker.x, marker.y, marker.x + board.marker_m, marker.y + board.marker_m},
           {corner.x, corner.y, corner.x + board.square_m, corner.y + board.square_m}});
      ++next;
    }
  }
  // Beside the squares' corners and the markers, not through them.
  for (int i = 1; i < board.squares_x; ++i) {
    picture.seams_x.push_back(edge + i * board.square_m + 0.5 * inset);
  }
  for (int i = 1; i < board.squares_y; ++i) {
    picture.seams_y.push_back(edge + i * board.square_m + 0.5 * inset);
  }
  picture.below = {edge, edge + board.square_m, mm_text(board.square_m)};
  const PrintBox& marker = picture.tags.front().square;
  picture.above = {marker.left, marker.right, mm_text(board.marker_m)};
  return picture;
}

PageFrame frame_of(const AprilGrid& grid, const TagFamilyShape& family) {
  PageFrame frame;
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
  frame.table = lines_of(board_table(grid));
  return frame;
}

PageFrame frame_of(const CharucoBoard& board) {
  const std::string squares =
      std::to_string(board.squares_x) + " x " + std::to_string(board.squares_y);
  PageFrame frame;
  frame.title = "ChArUco " + squares + ", " + board.dictionary;
  frame.how_to =
      "Glue it to a plate that is flat and stiff, without bubbles. The arrows show the "
      "edge of a square and of a marker.";
  if (board.squares_y % 2 == 0) {
    frame.how_to +=
        " OpenCV before 4.6 wants another pattern for an even number of rows.";
  }
  frame.table = {"squares    " + squares,
                 "square     " + mm_text(board.square_m),
                 "marker     " + mm_text(board.marker_m),
                 "dictionary " + board.dictionary};
  return frame;
}

}  // namespace

std::string board_table(const AprilGrid& grid) {
  TomlWriter writer;
  writer.table({"board"});
  writer.text("type", "aprilgrid");
  writer.integer("rows", grid.rows);
  writer.integer("columns", grid.columns);
  writer.number("tag_size_m", grid.tag_size_m);
  writer.number("gap_m", grid.gap_m);
  writer.integer("first_id", grid.first_id);
  writer.number("thickness_m", grid.thickness_m);
  std::string text = writer.str();
  text.erase(0, text.find_first_not_of('\n'));
  return text;
}

Result<PrintedDocument> lay_out_board(const AprilGrid& grid,
                                      const TagFamilyShape& family,
                                      std::span<const TagPattern> patterns,
                                      const BoardPages& pages) {
  MAREY_ASSERT(grid.rows > 0 && grid.columns > 0 &&
               patterns.size() == static_cast<std::size_t>(grid.tag_count()));
  const double cell = grid.tag_size_m / family.square_cells;
  const int outer_cells = family.white_square ? family.cells - family.square_cells : 0;
  const double least_gap = (outer_cells + 1) * cell;
  if (grid.gap_m < least_gap - kRounding_m) {
    return bad_input(
        "gap",
        mm_text(grid.gap_m) + " between tags of " + mm_text(grid.tag_size_m) +
            " is too little for " + family.name,
        "use at least " + mm_text(least_gap) + ": every tag wants white around it");
  }
  return tile(picture_of(grid, family, patterns), frame_of(grid, family), pages);
}

Result<PrintedDocument> lay_out_board(const CharucoBoard& board,
                                      std::span<const TagPattern> patterns,
                                      const BoardPages& pages) {
  MAREY_ASSERT(board.squares_x > 1 && board.squares_y > 1 &&
               patterns.size() == static_cast<std::size_t>(board.marker_count()));
  const double cell = board.marker_m / patterns.front().cells;
  const double least_white = 0.5 * cell;
  if (0.5 * (board.square_m - board.marker_m) < least_white - kRounding_m) {
    return bad_input(
        "marker",
        "markers of " + mm_text(board.marker_m) +
            " leave too little white in squares of " + mm_text(board.square_m),
        "use --marker-size " +
            mm_text(board.square_m / (1.0 + 1.0 / patterns.front().cells)) + " or less");
  }
  return tile(picture_of(board, patterns), frame_of(board), pages);
}

}  // namespace marey::recordings
