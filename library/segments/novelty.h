// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace marey::library {

/// Rows on either side of a boundary: 1 s.
inline constexpr int kNoveltyRows = 10;

/// Returns for each row how much the features of the second before it differ from those
/// of the second from it on: the mean distance of a row before from a row after, less the
/// mean distance of two rows on the same side (a checkerboard kernel on the distances of
/// all rows; Foote 2000, "Automatic audio segmentation using a measure of audio
/// novelty"). 0 where a side has less than a second. Cost: 200 distances per row.
/// Precondition: rows of kFeatureStride floats.
[[nodiscard]] std::vector<double> novelty(std::span<const float> rows);

/// Returns the rows at which the content of a motion changes, ascending: maxima of the
/// novelty over its mean plus two standard deviations, the highest first, none within 1 s
/// of another one or of an end.
[[nodiscard]] std::vector<int> find_changes(std::span<const float> rows);

}  // namespace marey::library
