// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace marey::dynamics {

/// Symmetric positive definite band matrix and its Cholesky factor. Rows of the lower
/// triangle are stored with `band` entries left of the diagonal.
class BandedCholesky {
 public:
  BandedCholesky(std::size_t size, std::size_t band);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Sets all entries to 0.
  void clear();
  /// Adds to an entry of the lower triangle. Precondition: column <= row <= column +
  /// band.
  void add(std::size_t row, std::size_t column, double value) {
    entries_[row * (band_ + 1) + band_ - (row - column)] += value;
  }
  /// Replaces the entries by the factor. Pivots that rounding made too small are raised.
  /// Cost: size * band^2.
  void factorize();
  /// Solves in place. Precondition: factorized; `x` has size() entries.
  void solve(std::span<double> x) const;

 private:
  std::size_t size_ = 0;
  std::size_t band_ = 0;
  std::vector<double> entries_;
};

}  // namespace marey::dynamics
