// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "library/search/clip_rows.h"

namespace marey::library {

/// The row of a clip that is nearest to a query.
struct ScanHit {
  int clip = 0;
  int row = 0;                    ///< In the clip; the first one of equal distance.
  float squared_distance = 0.0F;  ///< Sum of squared differences.
};

/// Compares every row of every clip with the query and returns the nearest row of each
/// clip that has rows, in clip order. The same bytes for all vector widths.
/// Linear in floats: reads all of them once. Allocates the result.
/// Precondition: the query has as many floats as a row, a multiple of 16; the last value
/// of `begins` is the number of rows.
[[nodiscard]] std::vector<ScanHit> nearest_rows(const ClipRows& clips,
                                                std::span<const float> query);

/// Keeps the `count` nearest clips, in ascending order of distance; clips of the same
/// distance in clip order.
void keep_nearest(std::vector<ScanHit>& hits, int count);

}  // namespace marey::library
