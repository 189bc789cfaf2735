// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: what board a camera saw, whatever was declared.

#include <optional>

#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// How the tags of a grid lie, as far as they were seen: outer rows that no frame shows
/// are missing.
struct SeenLayout {
  int rows = 0;
  int columns = 0;
  int first_id = 0;
  friend bool operator==(const SeenLayout&, const SeenLayout&) = default;
};

/// The layout of the grid of tags that `camera` saw, from which ids are next to each
/// other: one apart along a row, as many as there are columns from row to row. nullopt
/// where neighbours do not agree on one such grid, or too few of them were seen. Tags on
/// bodies do no harm as long as most neighbours are the board's.
[[nodiscard]] std::optional<SeenLayout> seen_layout(const CameraDetections& camera);

/// Whether tags that lie so may be tags of `board`: every id has the same place in its
/// row.
[[nodiscard]] bool agrees(const SeenLayout& seen, const AprilGrid& board);

/// How far the board's tags, or points, went from where they were first seen: the
/// farthest that half of them went, [px]. 0 when none was seen.
[[nodiscard]] double travel_px(const CameraDetections& camera,
                               const CalibrationTarget& board);

}  // namespace marey::calib
