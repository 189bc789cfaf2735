// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_tiles.h"

#include <algorithm>
#include <cstddef>

#include "recordings/print/print_marks.h"

namespace marey::recordings {
namespace {

constexpr double kOverlap_m = 0.010;
constexpr double kTileRounding_m = 1e-9;
constexpr double kSmallText_m = 0.0024;
/// A board with more pages has a wrong unit.
constexpr std::size_t kMaxPages = 60;

/// Returns the starts of the tiles along one edge, in the board's picture; nullopt if a
/// part between two seams is wider than a page.
std::optional<std::vector<double>> starts_of_tiles(double board_m,
                                                   double room_m,
                                                   const std::vector<double>& seams) {
  std::vector<double> starts{0.0};
  while (board_m - starts.back() > room_m + kTileRounding_m) {
    const double last = starts.back() + room_m - kOverlap_m + kTileRounding_m;
    const auto beyond = std::upper_bound(seams.begin(), seams.end(), last);
    if (beyond == seams.begin() || *(beyond - 1) <= starts.back()) return std::nullopt;
    starts.push_back(*(beyond - 1));
  }
  return starts;
}

/// The paper, and the part of the board on each page.
struct Tiling {
  Paper paper;
  PrintBox room;  ///< The same on every page.
  std::vector<double> left;
  std::vector<double> top;

  [[nodiscard]] std::size_t pages() const { return left.size() * top.size(); }
};

std::optional<Tiling> tiling_on(const Paper& paper,
                                const BoardPicture& board,
                                const PrintFrame& frame) {
  const PrintBox space = space_for_patterns(paper, frame);
  Tiling tiling{paper,
                {space.left + kBoardBand_m,
                 space.top + kBoardBand_m,
                 space.right - kBoardBand_m,
                 space.bottom - kBoardBand_m},
                {},
                {}};
  const auto left = starts_of_tiles(board.width, tiling.room.width(), board.seams_x);
  const auto top = starts_of_tiles(board.height, tiling.room.height(), board.seams_y);
  if (!left || !top || left->size() * top->size() > kMaxPages) return std::nullopt;
  tiling.left = *left;
  tiling.top = *top;
  return tiling;
}

PrintBox moved(const PrintBox& box, const glm::dvec2& by) {
  return {box.left + by.x, box.top + by.y, box.right + by.x, box.bottom + by.y};
}

PrintBox common(const PrintBox& a, const PrintBox& b) {
  return {std::max(a.left, b.left),
          std::max(a.top, b.top),
          std::min(a.right, b.right),
          std::min(a.bottom, b.bottom)};
}

bool holds(const PrintBox& outer, const PrintBox& inner) {
  return inner.left >= outer.left - kTileRounding_m &&
         inner.top >= outer.top - kTileRounding_m &&
         inner.right <= outer.right + kTileRounding_m &&
         inner.bottom <= outer.bottom + kTileRounding_m;
}

/// One page of the board.
class Tile {
 public:
  Tile(const BoardPicture& board,
       const Tiling& tiling,
       std::size_t row,
       std::size_t column)
      : board_(board), tiling_(tiling), row_(row), column_(column) {
    const glm::dvec2 from{tiling.left[column], tiling.top[row]};
    const glm::dvec2 left_over{board.width - from.x, board.height - from.y};
    // The last tile of a row ends at the board's edge, others include their neighbour's
    // edge.
    const double width = column + 1 < tiling.left.size()
                             ? tiling.left[column + 1] - from.x + kOverlap_m
                             : left_over.x;
    const double height = row + 1 < tiling.top.size()
                              ? tiling.top[row + 1] - from.y + kOverlap_m
                              : left_over.y;
    const PrintBox& room = tiling.room;
    const double spare = tiling.left.size() == 1 ? 0.5 * (room.width() - width) : 0.0;
    window_ = {room.left + spare,
               room.top,
               room.left + spare + std::min(width, left_over.x),
               room.top + std::min(height, left_over.y)};
    page_from_board_ = glm::dvec2(window_.left, window_.top) - from;
  }

  void draw(PrintedPage& page) const {
    draw_board(page);
    add_cut_marks(page, window_);
    draw_seams(page);
    draw_lengths(page);
    draw_origin(page);
  }

 private:
  void draw_board(PrintedPage& page) const;
  void draw_seams(PrintedPage& page) const;
  void draw_lengths(PrintedPage& page) const;
  void draw_origin(PrintedPage& page) const;
  void draw_length(PrintedPage& page, const ShownLength& length, double y) const;

  const BoardPicture& board_;
  const Tiling& tiling_;
  std::size_t row_;
  std::size_t column_;
  PrintBox window_;                  ///< Area of the page for the board.
  glm::dvec2 page_from_board_{0.0};  ///< Offset from board to page.
};

void Tile::draw_board(PrintedPage& page) const {
  PrintedBoxes black;
  for (const PrintBox& box : board_.black) {
    const PrintBox seen = common(moved(box, page_from_board_), window_);
    if (seen.width() > 0.0 && seen.height() > 0.0) black.boxes.push_back(seen);
  }
  page.shapes.emplace_back(black);
  for (const PrintedTag& tag : board_.tags) {
    const PrintedTag here{
        tag.id, moved(tag.square, page_from_board_), moved(tag.clear, page_from_board_)};
    if (holds(window_, here.square)) page.tags.push_back(here);
  }
}

/// Draws ticks at the position of the next sheet's edge.
void Tile::draw_seams(PrintedPage& page) const {
  constexpr double kNear_m = 0.0006;
  constexpr double kFar_m = 0.005;
  const auto tick = [&](const glm::dvec2& from, const glm::dvec2& to) {
    page.shapes.emplace_back(PrintedLine{{from, to}, 0.00015, Ink::kBlack});
  };
  const std::size_t sheet = row_ * tiling_.left.size() + column_ + 1;
  if (column_ + 1 < tiling_.left.size()) {
    const double x = tiling_.left[column_ + 1] + page_from_board_.x;
    tick({x, window_.top - kFar_m}, {x, window_.top - kNear_m});
    tick({x, window_.bottom + kNear_m}, {x, window_.bottom + kFar_m});
    page.shapes.emplace_back(PrintedText{"edge of page " + std::to_string(sheet + 1),
                                         {x - 0.001, window_.top - 0.0025},
                                         TextSide::kRight,
                                         kSmallText_m});
  }
  if (row_ + 1 < tiling_.top.size()) {
    const double y = tiling_.top[row_ + 1] + page_from_board_.y;
    tick({window_.left - kFar_m, y}, {window_.left - kNear_m, y});
    tick({window_.right + kNear_m, y}, {window_.right + kFar_m, y});
    page.shapes.emplace_back(
        PrintedText{"edge of page " + std::to_string(sheet + tiling_.left.size()),
                    {window_.left, window_.bottom + 0.0065},
                    TextSide::kLeft,
                    kSmallText_m});
  }
}

void Tile::draw_length(PrintedPage& page, const ShownLength& length, double y) const {
  const double left = length.left + page_from_board_.x;
  const double right = length.right + page_from_board_.x;
  if (length.text.empty() || left < window_.left || right > window_.right) return;
  add_dimension(page, {left, right, y, kSmallText_m, length.text});
}

void Tile::draw_lengths(PrintedPage& page) const {
  if (row_ == 0) draw_length(page, board_.above, window_.top - 0.0032);
  if (row_ + 1 == tiling_.top.size()) {
    draw_length(page, board_.below, window_.bottom + 0.0022);
  }
}

void Tile::draw_origin(PrintedPage& page) const {
  const bool is_here = column_ == 0 && row_ + 1 == tiling_.top.size();
  if (!board_.origin || !is_here) return;
  const glm::dvec2 origin = *board_.origin + page_from_board_;
  constexpr double kAxis_m = 0.012;
  constexpr double kHead_m = 0.0018;
  const double y = window_.bottom + 0.0057;
  const double x = window_.left - 0.0035;
  add_arrow(page, {origin.x, y}, {origin.x + kAxis_m, y}, kHead_m);
  add_arrow(page, {x, origin.y}, {x, origin.y - kAxis_m}, kHead_m);
  page.shapes.emplace_back(PrintedText{"x   " + board_.origin_text,
                                       {origin.x + kAxis_m + 0.001, y + 0.0008},
                                       TextSide::kLeft,
                                       kSmallText_m});
  page.shapes.emplace_back(PrintedText{
      "y", {x, origin.y - kAxis_m - 0.0012}, TextSide::kMiddle, kSmallText_m});
}

Error too_large(const BoardPicture& board,
                const PrintFrame& frame,
                const BoardPages& pages,
                const char* other) {
  const PrintBox space = space_for_patterns(pages.paper, frame);
  return bad_input(board.name,
                   "it is " + mm_text(board.width) + " x " + mm_text(board.height) +
                       ", and " + pages.paper.name + " has room for " +
                       mm_text(space.width() - 2.0 * kBoardBand_m) + " x " +
                       mm_text(space.height() - 2.0 * kBoardBand_m),
                   "use --page " +
                       page_that_holds(board.width + 2.0 * kBoardBand_m,
                                       board.height + 2.0 * kBoardBand_m,
                                       pages.paper,
                                       frame) +
                       other);
}

}  // namespace

Result<PrintedDocument> tile(const BoardPicture& board,
                             const PrintFrame& frame,
                             const BoardPages& pages) {
  const Status usable = check_paper(pages.paper);
  if (!usable) return usable.error();
  std::optional<Tiling> best = tiling_on(pages.paper, board, frame);
  const auto lying = tiling_on(turned(pages.paper), board, frame);
  if (lying && (!best || lying->pages() < best->pages())) best = lying;
  if (!best) return too_large(board, frame, pages, ", or smaller tags");
  if (pages.one_page && best->pages() > 1) {
    return too_large(board, frame, pages, ", or leave --one-page out to glue several");
  }
  PrintFrame tiled = frame;
  if (best->pages() > 1) {
    tiled.how_to =
        "Cut each page at its corner marks, then glue it onto its left and upper "
        "neighbours so that its edge meets their ticks and the pattern goes on. " +
        frame.how_to;
    // The longer text reduces the space, so the layout is computed again with it.
    const auto again = tiling_on(best->paper, board, tiled);
    if (!again) return too_large(board, frame, pages, ", or smaller tags");
    best = again;
  }
  PrintedDocument document{"Board: " + frame.title, {}};
  const auto count = static_cast<int>(best->pages());
  for (std::size_t row = 0; row < best->top.size(); ++row) {
    for (std::size_t column = 0; column < best->left.size(); ++column) {
      const auto number = static_cast<int>(document.pages.size()) + 1;
      PrintedPage page = framed_page(best->paper, tiled, number, count);
      Tile(board, *best, row, column).draw(page);
      document.pages.push_back(std::move(page));
    }
  }
  return document;
}

}  // namespace marey::recordings
