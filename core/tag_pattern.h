// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace marey {

/// A printed tag: square cells, black or white, rows from the top of the upright tag.
struct TagPattern {
  int cells = 0;  ///< In a row and in a column, quiet zone included.
  /// From the edge of the pattern to the square whose corners are detected.
  int margin_cells = 0;
  std::vector<std::uint8_t> white;  ///< cells * cells; 1 is white.
};

/// Common properties of all tags of a family.
struct TagFamilyShape {
  std::string name;      ///< Name in libapriltag.
  int tag_count = 0;     ///< Ids are 0 to tag_count - 1.
  int cells = 0;         ///< TagPattern::cells.
  int square_cells = 0;  ///< Along an edge of the detected square: its size.
  /// The square is white and lies in a black ring, with more cells around it. Otherwise
  /// it is black, and the pattern's outermost ring is its quiet zone.
  bool white_square = false;
};

}  // namespace marey
