// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "library/search/row_kernel.h"
#include <xsimd/xsimd.hpp>

namespace marey::library {

/// The loop of a row kernel for vectors of xsimd's type Batch. Its name contains the
/// instruction set, so that no other object has a function of the same name.
template <class Batch>
struct RowLoop {
  static void run(const float* rows,
                  std::size_t count,
                  std::size_t columns,
                  const float* query,
                  float* out) {
    constexpr std::size_t kLanes = Batch::size;
    constexpr std::size_t kBatches = kRowParts / kLanes;
    for (std::size_t r = 0; r < count; ++r, rows += columns) {
      Batch sums[kBatches];
      for (std::size_t b = 0; b < kBatches; ++b) sums[b] = Batch(0.0F);
      for (std::size_t c = 0; c < columns; c += kRowParts) {
        for (std::size_t b = 0; b < kBatches; ++b) {
          const std::size_t at = c + b * kLanes;
          const Batch d =
              Batch::load_unaligned(rows + at) - Batch::load_unaligned(query + at);
          sums[b] = sums[b] + d * d;
        }
      }
      for (std::size_t half = kBatches / 2; half > 0; half /= 2) {
        for (std::size_t b = 0; b < half; ++b) sums[b] = sums[b] + sums[b + half];
      }
      float parts[kLanes];
      sums[0].store_unaligned(parts);
      for (std::size_t half = kLanes / 2; half > 0; half /= 2) {
        for (std::size_t k = 0; k < half; ++k) parts[k] += parts[k + half];
      }
      out[r] = parts[0];
    }
  }
};

}  // namespace marey::library
