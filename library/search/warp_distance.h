// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace marey::library {

/// Part of a clip that a query is aligned with.
struct WarpMatch {
  double distance = 0.0;  ///< See warp_distance().
  int first_row = 0;      ///< In the clip.
  int last_row = 0;
};

/// Part of the clip that must be matched.
enum class WarpEnds {
  kSubsequence,  ///< Any.
  kWhole,        ///< From its first to its last row.
};

/// Memory of warp_distance() that is used again: it grows to the longest clip.
struct WarpScratch {
  std::vector<float> values;
  std::vector<int> starts;
};

/// Computes the distance of a query from a clip by dynamic time warping with the steps
/// (1,1), (2,1) and (1,2), so that nothing is stretched more than twofold (Müller,
/// Information Retrieval for Music and Motion, 2007, chapters 4 and 7). With the distance
/// c(i,j) of row i of the query from row j of the clip:
///
///   D(i,j) = c(i,j) + min{ D(i-1,j-1), D(i-2,j-1) + c(i-1,j), D(i-1,j-2) + c(i,j-1) }
///
/// kSubsequence: D(1,j) = c(1,j), and the distance is min over j of D(n,j) / n for a
/// query of n rows. kWhole: D(1,1) = c(1,1), the other D(1,j) are infinite, and the
/// distance is D(n,m) / max(n,m) for a clip of m rows. Equal distances: the earliest end
/// in the clip; of equal steps the first in the order above. Computed in float, the same
/// bytes on every processor.
///
/// nullopt: the clip is too short or, for kWhole, too long, or the distance is above
/// `max_distance`. A search among many clips passes its worst distance that still counts:
/// the computation stops at the first row of the query where no alignment can reach it,
/// which does not change results.
///
/// Cost: n m distances of 64 floats. Allocates only if `scratch` must grow.
/// Precondition: rows of kFeatureStride floats; the query has a row; finite values.
[[nodiscard]] std::optional<WarpMatch> warp_distance(
    std::span<const float> query,
    std::span<const float> clip,
    WarpEnds ends,
    WarpScratch& scratch,
    double max_distance = std::numeric_limits<double>::infinity());

}  // namespace marey::library
