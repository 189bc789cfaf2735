// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/banded_cholesky.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

// Smallest pivot, as a share of the diagonal entry.
constexpr double kMinPivotShare = 1e-14;

}  // namespace

BandedCholesky::BandedCholesky(std::size_t size, std::size_t band)
    : size_(size), band_(band), entries_(size * (band + 1), 0.0) {}

void BandedCholesky::clear() {
  std::fill(entries_.begin(), entries_.end(), 0.0);
}

void BandedCholesky::factorize() {
  const std::size_t width = band_ + 1;
  for (std::size_t i = 0; i < size_; ++i) {
    double* row = &entries_[i * width];
    const std::size_t from = i > band_ ? i - band_ : 0;
    for (std::size_t j = from; j <= i; ++j) {
      const double* other = &entries_[j * width];
      const std::size_t other_from = j > band_ ? j - band_ : 0;
      double sum = row[band_ - (i - j)];
      for (std::size_t k = std::max(from, other_from); k < j; ++k) {
        sum -= row[band_ - (i - k)] * other[band_ - (j - k)];
      }
      if (j < i) {
        row[band_ - (i - j)] = sum / other[band_];
      } else {
        row[band_] = std::sqrt(std::max(sum, kMinPivotShare * row[band_]));
      }
    }
  }
}

void BandedCholesky::solve(std::span<double> x) const {
  MAREY_ASSERT(x.size() == size_);
  const std::size_t width = band_ + 1;
  for (std::size_t i = 0; i < size_; ++i) {
    const double* row = &entries_[i * width];
    double sum = x[i];
    for (std::size_t k = i > band_ ? i - band_ : 0; k < i; ++k) {
      sum -= row[band_ - (i - k)] * x[k];
    }
    x[i] = sum / row[band_];
  }
  for (std::size_t i = size_; i-- > 0;) {
    const double* row = &entries_[i * width];
    x[i] /= row[band_];
    for (std::size_t k = i > band_ ? i - band_ : 0; k < i; ++k) {
      x[k] -= row[band_ - (i - k)] * x[i];
    }
  }
}

}  // namespace marey::dynamics
