// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "retarget/base/lanes.h"

namespace marey::retarget {

/// Solves a symmetric positive definite system in place. `blocks` is its lower triangle
/// of 3x3 blocks (row-major in both: block (i, j) at 9 (i side + j)) and becomes the
/// factor (with inverse diagonal); `right` becomes the solution. Pivots that rounding
/// reduced below `min_pivot` are replaced by it. Costs about 4.5 side^3 multiplications.
template <class F>
void solve_blocks(int side, const F& min_pivot, F* blocks, Vec3<F>* right);

namespace detail {

template <class F>
inline void factor_diagonal(const F& min_pivot, F* d) {
  const F one = num<F>(1);
  // Lower triangle; the diagonal is stored inverted.
  d[0] = one / sqrt(max(d[0], min_pivot));
  d[3] = d[3] * d[0];
  d[6] = d[6] * d[0];
  d[4] = one / sqrt(max(d[4] - d[3] * d[3], min_pivot));
  d[7] = (d[7] - d[6] * d[3]) * d[4];
  d[8] = one / sqrt(max(d[8] - d[6] * d[6] - d[7] * d[7], min_pivot));
}

// x := x L^-T for the 3 rows of x.
template <class F>
inline void divide_by_transposed(const F* d, F* x) {
  for (std::size_t r = 0; r < 9; r += 3) {
    x[r] = x[r] * d[0];
    x[r + 1] = (x[r + 1] - x[r] * d[3]) * d[4];
    x[r + 2] = (x[r + 2] - x[r] * d[6] - x[r + 1] * d[7]) * d[8];
  }
}

// c := c - a b'
template <class F>
inline void subtract_product(const F* a, const F* b, F* c) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) {
      c[3 * r + k] = c[3 * r + k] - a[3 * r] * b[3 * k] - a[3 * r + 1] * b[3 * k + 1] -
                     a[3 * r + 2] * b[3 * k + 2];
    }
  }
}

template <class F>
inline void subtract(const F* a, const Vec3<F>& v, Vec3<F>& from) {
  from.x = from.x - a[0] * v.x - a[1] * v.y - a[2] * v.z;
  from.y = from.y - a[3] * v.x - a[4] * v.y - a[5] * v.z;
  from.z = from.z - a[6] * v.x - a[7] * v.y - a[8] * v.z;
}

template <class F>
inline void subtract_transposed(const F* a, const Vec3<F>& v, Vec3<F>& from) {
  from.x = from.x - a[0] * v.x - a[3] * v.y - a[6] * v.z;
  from.y = from.y - a[1] * v.x - a[4] * v.y - a[7] * v.z;
  from.z = from.z - a[2] * v.x - a[5] * v.y - a[8] * v.z;
}

}  // namespace detail

template <class F>
void solve_blocks(int side, const F& min_pivot, F* blocks, Vec3<F>* right) {
  const auto at = [&](int i, int j) {
    return blocks + 9 * (static_cast<std::ptrdiff_t>(i) * side + j);
  };
  for (int j = 0; j < side; ++j) {
    for (int k = 0; k < j; ++k) detail::subtract_product(at(j, k), at(j, k), at(j, j));
    detail::factor_diagonal(min_pivot, at(j, j));
    for (int i = j + 1; i < side; ++i) {
      for (int k = 0; k < j; ++k) detail::subtract_product(at(i, k), at(j, k), at(i, j));
      detail::divide_by_transposed(at(j, j), at(i, j));
    }
  }
  for (int i = 0; i < side; ++i) {
    for (int k = 0; k < i; ++k) detail::subtract(at(i, k), right[k], right[i]);
    const F* d = at(i, i);
    Vec3<F>& x = right[i];
    x.x = x.x * d[0];
    x.y = (x.y - d[3] * x.x) * d[4];
    x.z = (x.z - d[6] * x.x - d[7] * x.y) * d[8];
  }
  for (int i = side; i-- > 0;) {
    for (int k = i + 1; k < side; ++k) {
      detail::subtract_transposed(at(k, i), right[k], right[i]);
    }
    const F* d = at(i, i);
    Vec3<F>& x = right[i];
    x.z = x.z * d[8];
    x.y = (x.y - d[7] * x.z) * d[4];
    x.x = (x.x - d[3] * x.y - d[6] * x.z) * d[0];
  }
}

}  // namespace marey::retarget
