// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "core/board.h"
#include "core/result.h"
#include "core/tag_pattern.h"
#include "recordings/printed_page.h"

namespace marey::recordings {

/// A chessboard with markers in its white squares, as OpenCV from 4.6 on has it: the top
/// left square is black, ids grow along the rows from the top.
struct CharucoBoard {
  int squares_x = 5;
  int squares_y = 7;
  double square_m = 0.030;
  double marker_m = 0.022;  ///< Edge of a marker, its black frame included.
  std::string dictionary = "DICT_5X5_100";

  [[nodiscard]] int marker_count() const { return squares_x * squares_y / 2; }
};

struct BoardPages {
  Paper paper;
  /// Refuse a board that needs more than one page, rather than tile it.
  bool one_page = false;
};

/// The [board] table of the session.toml that belongs to this board.
[[nodiscard]] std::string board_table(const AprilGrid& grid);

/// A grid as core/board.h has it, on one page, or on several to be glued together: these
/// meet in the middle of gaps, and overlap. Errors (kBadInput): the gap has no room for
/// quiet zones; the paper is too small for the ruler or for one tag, or would be many.
/// Precondition: a pattern for each tag of the board, in the order of ids.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const AprilGrid& grid,
                                                    const TagFamilyShape& family,
                                                    std::span<const TagPattern> patterns,
                                                    const BoardPages& pages);

/// The same for a chessboard. Errors also: markers that are larger than their squares
/// allow. Precondition: a pattern for each marker, in the order of ids.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const CharucoBoard& board,
                                                    std::span<const TagPattern> patterns,
                                                    const BoardPages& pages);

}  // namespace marey::recordings
