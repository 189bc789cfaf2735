// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/print/board_pages.h"
#include "recordings/print/print_frame.h"
#include "recordings/print/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

/// A dimension that is drawn next to the board.
struct ShownLength {
  double left = 0.0;
  double right = 0.0;
  std::string text;
};

/// A picture of a board, in metres from its top left corner, y down.
struct BoardPicture {
  double width = 0.0;
  double height = 0.0;
  std::vector<PrintBox> black;
  std::vector<PrintedTag> tags;
  /// Allowed positions of cuts between pages: x and y, ascending.
  std::vector<double> seams_x;
  std::vector<double> seams_y;
  ShownLength above;
  ShownLength below;
  /// Origin of the board's frame, if it is drawn: at the bottom left.
  std::optional<glm::dvec2> origin;
  std::string origin_text;
  std::string name;  ///< "the board", for messages.
};

/// Width of the band around the board on each page, for text. [m]
inline constexpr double kBoardBand_m = 0.0075;

/// Lays out a board on one page, or on several. Errors: those of lay_out_board() about
/// paper.
[[nodiscard]] Result<PrintedDocument> tile(const BoardPicture& board,
                                           const PrintFrame& frame,
                                           const BoardPages& pages);

}  // namespace marey::recordings
