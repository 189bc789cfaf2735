// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the layout of the board in view, independent of the declared board.

#include <optional>

#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// Layout of the seen tags of a grid. Outer rows that no frame shows are missing.
struct SeenLayout {
  int rows = 0;
  int columns = 0;
  int first_id = 0;
  friend bool operator==(const SeenLayout&, const SeenLayout&) = default;
};

/// Returns the layout of the grid of tags that `camera` saw, computed from the ids of
/// neighbouring tags: they differ by one along a row, and by the number of columns from
/// row to row. Returns nullopt if neighbours do not agree on one grid, or too few are
/// seen. Tags on bodies are tolerated if most neighbours are the board's.
[[nodiscard]] std::optional<SeenLayout> seen_layout(const CameraDetections& camera);

/// Returns true if tags of this layout may be tags of `board`: every id has the same
/// position in its row.
[[nodiscard]] bool layout_matches(const SeenLayout& seen, const AprilGrid& board);

/// Returns the motion of the board's tags, or points, relative to their first pixels: the
/// largest distance that half of them reached [px]. Returns 0 if none was seen.
[[nodiscard]] double travel_px(const CameraDetections& camera,
                               const CalibrationTarget& board);

}  // namespace marey::calib
