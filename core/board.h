// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "core/assert.h"
#include "core/ids.h"

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
  double thickness_m = 0.0;  ///< Of the plate: how far its face is above the floor.

  [[nodiscard]] int tag_count() const { return rows * columns; }

  [[nodiscard]] bool contains(TagId id) const {
    return number(id) >= first_id && number(id) < first_id + tag_count();
  }

  /// Corner `corner` (0..3, the order of TagDetection::corners_px) of tag `id`, in the
  /// board's frame. [m] nullopt when the tag is not on this board.
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

}  // namespace marey
