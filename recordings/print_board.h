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

struct BoardPages {
  Paper paper;
  /// Refuse a board that needs more than one page, rather than tile it.
  bool one_page = false;
};

/// The [board] table of the session.toml that belongs to this board. `family` is that of
/// an AprilGrid's tags.
[[nodiscard]] std::string board_table(const AprilGrid& grid, const std::string& family);
[[nodiscard]] std::string board_table(const CharucoBoard& board);
[[nodiscard]] std::string board_table(const Chessboard& board);

/// A grid as core/board.h has it, on one page, or on several to be glued together: these
/// meet in the middle of gaps, and overlap. Errors (kBadInput): the gap has no room for
/// quiet zones; the paper is too small for the ruler or for one tag, or would be many.
/// Precondition: a pattern for each tag of the board, in the order of ids.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const AprilGrid& grid,
                                                    const TagFamilyShape& family,
                                                    std::span<const TagPattern> patterns,
                                                    const BoardPages& pages);

/// The same for a chessboard with markers. Errors also: markers that are larger than
/// their squares allow; a board that is inverted, or has two sides, which is not printed.
/// Precondition: a pattern for each marker, in the order of ids.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const CharucoBoard& board,
                                                    std::span<const TagPattern> patterns,
                                                    const BoardPages& pages);

/// The same for a chessboard. Errors also: one that looks the same after half a turn.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const Chessboard& board,
                                                    const BoardPages& pages);

}  // namespace marey::recordings
