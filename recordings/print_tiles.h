// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/print_board.h"
#include "recordings/print_frame.h"
#include "recordings/printed_page.h"

// Private to recordings/.
namespace marey::recordings {

/// A distance that is shown beside the board.
struct ShownLength {
  double left = 0.0;
  double right = 0.0;
  std::string text;
};

/// A board as a picture, in metres from its top left corner, y down.
struct BoardPicture {
  double width = 0.0;
  double height = 0.0;
  std::vector<PrintBox> black;
  std::vector<PrintedTag> tags;
  /// Where it may be parted: x and y, ascending.
  std::vector<double> seams_x;
  std::vector<double> seams_y;
  ShownLength above;
  ShownLength below;
  /// Of the board's frame, when it is shown: at its bottom left.
  std::optional<glm::dvec2> origin;
  std::string origin_text;
  std::string name;  ///< "the board", for messages.
};

/// Around the board on each page, for what is written beside it. [m]
inline constexpr double kBoardBand_m = 0.0075;

/// On one page, or on several. Errors as lay_out_board()'s about paper.
[[nodiscard]] Result<PrintedDocument> tile(const BoardPicture& board,
                                           const PageFrame& frame,
                                           const BoardPages& pages);

}  // namespace marey::recordings
