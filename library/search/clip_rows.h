// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/assert.h"

namespace marey::library {

/// A view of rows of floats of all clips, in clip order, in memory or in a mapped file.
struct ClipRows {
  std::span<const float> values;
  std::size_t columns = 0;
  /// First row of each clip, and last the number of all rows: clips + 1 values.
  std::span<const std::uint64_t> begins;

  [[nodiscard]] int clip_count() const {
    return begins.empty() ? 0 : static_cast<int>(begins.size()) - 1;
  }
  [[nodiscard]] std::size_t row_count(int clip) const {
    const auto k = static_cast<std::size_t>(clip);
    return static_cast<std::size_t>(begins[k + 1] - begins[k]);
  }
  /// Returns the rows of one clip. Precondition: 0 <= clip < clip_count().
  [[nodiscard]] std::span<const float> rows(int clip) const {
    MAREY_ASSERT(clip >= 0 && clip < clip_count());
    const auto first = static_cast<std::size_t>(begins[static_cast<std::size_t>(clip)]);
    return values.subspan(first * columns, row_count(clip) * columns);
  }
};

}  // namespace marey::library
