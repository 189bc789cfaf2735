// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey {

/// Returns the matrix whose product with x is the cross product of v and x. `Matrix` is a
/// 3 x 3 matrix with m(row, column), `Vector` has x(), y() and z(), as those of Eigen:
/// core itself does not depend on it.
template <class Matrix, class Vector>
[[nodiscard]] Matrix cross_matrix(const Vector& v) {
  Matrix m = Matrix::Zero();
  m(0, 1) = -v.z();
  m(0, 2) = v.y();
  m(1, 0) = v.z();
  m(1, 2) = -v.x();
  m(2, 0) = -v.y();
  m(2, 1) = v.x();
  return m;
}

}  // namespace marey
