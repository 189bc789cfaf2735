// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/row_kernel.h"

#include <initializer_list>

namespace marey::library {
namespace {

void scalar_distances(const float* rows,
                      std::size_t count,
                      std::size_t columns,
                      const float* query,
                      float* out) {
  for (std::size_t r = 0; r < count; ++r, rows += columns) {
    float parts[kRowParts] = {};
    for (std::size_t c = 0; c < columns; ++c) {
      const float d = rows[c] - query[c];
      parts[c % kRowParts] += d * d;
    }
    for (std::size_t half = kRowParts / 2; half > 0; half /= 2) {
      for (std::size_t k = 0; k < half; ++k) parts[k] += parts[k + half];
    }
    out[r] = parts[0];
  }
}

}  // namespace

SquaredDistances make_scalar_row_kernel() {
  return &scalar_distances;
}

bool has_row_lanes(RowLanes lanes) {
  switch (lanes) {
    case RowLanes::kOne:
      return true;
    case RowLanes::kFour:
      return make_narrow_row_kernel() != nullptr;
    case RowLanes::kEight:
#if defined(__x86_64__)
      return make_wide_row_kernel() != nullptr && __builtin_cpu_supports("avx2") != 0;
#else
      return false;
#endif
  }
  return false;
}

SquaredDistances squared_distances(RowLanes lanes) {
  switch (lanes) {
    case RowLanes::kOne:
      break;
    case RowLanes::kFour:
      return make_narrow_row_kernel();
    case RowLanes::kEight:
      return make_wide_row_kernel();
  }
  return make_scalar_row_kernel();
}

SquaredDistances squared_distances() {
  for (const RowLanes lanes : {RowLanes::kEight, RowLanes::kFour}) {
    if (has_row_lanes(lanes)) return squared_distances(lanes);
  }
  return make_scalar_row_kernel();
}

}  // namespace marey::library
