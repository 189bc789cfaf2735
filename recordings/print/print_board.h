// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "core/base/result.h"
#include "core/board.h"
#include "core/tag_pattern.h"
#include "recordings/print/board_pages.h"
#include "recordings/print/printed_page.h"

namespace marey::recordings {

/// Returns the [board] table of session.toml for this board. `family` is that of an
/// AprilGrid's tags.
[[nodiscard]] std::string board_table(const AprilGrid& grid, const std::string& family);
[[nodiscard]] std::string board_table(const CharucoBoard& board);
[[nodiscard]] std::string board_table(const Chessboard& board);

/// Lays out a grid (core/board.h) on one page, or on several to be glued together; these
/// meet in the middle of gaps, and overlap. Errors (kBadInput): the gap has no room for
/// quiet zones; the paper is too small for the ruler or for one tag, or too many pages
/// are needed. Precondition: a pattern for each tag of the board, in the order of ids.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const AprilGrid& grid,
                                                    const TagFamilyShape& family,
                                                    std::span<const TagPattern> patterns,
                                                    const BoardPages& pages);

/// Lays out a chessboard with markers in the same way. Additional errors: markers that
/// are too large for their squares; an inverted or two-sided board, which is not
/// supported. Precondition: a pattern for each marker, in the order of ids.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const CharucoBoard& board,
                                                    std::span<const TagPattern> patterns,
                                                    const BoardPages& pages);

/// Lays out a chessboard in the same way. Additional error: a board that looks the same
/// after half a turn.
[[nodiscard]] Result<PrintedDocument> lay_out_board(const Chessboard& board,
                                                    const BoardPages& pages);

}  // namespace marey::recordings
