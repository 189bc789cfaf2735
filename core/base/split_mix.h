// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace marey {

/// SplitMix64 (Steele, Lea, Flood 2014): numbers from a seed, the same on every machine,
/// for orders and generated values that belong to a result.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}

  [[nodiscard]] std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  /// Returns floor(next() * count / 2^64): 0 to count - 1. Precondition: count > 0.
  [[nodiscard]] std::uint64_t below(std::uint64_t count) {
    const std::uint64_t r = next();
    // The upper half of a product of 128 bits, by halves of 32 bits.
    const std::uint64_t low = (r & 0xFFFFFFFFU) * (count & 0xFFFFFFFFU);
    const std::uint64_t mid = (r >> 32U) * (count & 0xFFFFFFFFU) + (low >> 32U);
    const std::uint64_t mid2 = (r & 0xFFFFFFFFU) * (count >> 32U) + (mid & 0xFFFFFFFFU);
    return (r >> 32U) * (count >> 32U) + (mid >> 32U) + (mid2 >> 32U);
  }
  /// Returns a number in [0, 1).
  [[nodiscard]] double unit() { return static_cast<double>(next() >> 11U) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

}  // namespace marey
