// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace marey::library {

/// Columns of a row are summed in this many parts: column c belongs to part
/// c % kRowParts. Parts are then added in halves: k and k + 8, k and k + 4, k and k + 2,
/// 0 and 1. The order of all additions is therefore that of every vector width, and the
/// results are the same to the bit.
inline constexpr std::size_t kRowParts = 16;

/// Computes the squared distances of `count` consecutive rows from one query row.
/// Precondition: `columns` is a multiple of kRowParts.
using SquaredDistances = void (*)(const float* rows,
                                  std::size_t count,
                                  std::size_t columns,
                                  const float* query,
                                  float* out);

/// Floats that are processed in parallel.
enum class RowLanes { kOne = 1, kFour = 4, kEight = 8 };

/// Returns true if this build and this processor have the width.
[[nodiscard]] bool has_row_lanes(RowLanes lanes);

/// Returns the kernel of a width. Precondition: has_row_lanes(lanes).
[[nodiscard]] SquaredDistances squared_distances(RowLanes lanes);

/// Returns the kernel of the widest vectors of this processor.
[[nodiscard]] SquaredDistances squared_distances();

/// Kernels by width; nullptr: not built for this processor family. The caller must check
/// that the processor has the instructions.
[[nodiscard]] SquaredDistances make_scalar_row_kernel();
[[nodiscard]] SquaredDistances make_narrow_row_kernel();
[[nodiscard]] SquaredDistances make_wide_row_kernel();

}  // namespace marey::library
