// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

namespace marey::dynamics {

/// Cubic B-splines on x in [0, 1] with equally spaced, clamped knots, and their exact
/// integrals. Spline 0 is 1 at x = 0, the last one is 1 at x = 1; their sum is 1.
class ForceSplines {
 public:
  /// Coefficients of u^0 to u^3, where u runs from 0 to 1 over one knot interval.
  using Cubic = std::array<double, 4>;

  /// Precondition: count >= 4. Allocates; a solver keeps one object.
  explicit ForceSplines(int count);

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int intervals() const { return count_ - 3; }

  struct Place {
    int interval = 0;
    double u = 0.0;
  };
  /// Returns the knot interval that holds x. Precondition: 0 <= x <= 1.
  [[nodiscard]] Place place_of(double x) const;
  /// Returns spline `interval + k` on that interval. Precondition: 0 <= k < 4.
  [[nodiscard]] const Cubic& cubic(int interval, int k) const {
    return cubics_[static_cast<std::size_t>(4 * interval + k)];
  }

  /// Write the splines, their integrals from 0 to x, or the integrals of those integrals,
  /// into the first count() entries of `row`.
  void write_values(double x, std::span<double> row) const;
  void write_integrals(double x, std::span<double> row) const;
  void write_double_integrals(double x, std::span<double> row) const;

  /// Returns the integral over [0, 1] of B B' + weight * B'' B''', row by row.
  [[nodiscard]] std::vector<double> roughness_matrix(double weight) const;

 private:
  int count_ = 0;
  std::vector<Cubic> cubics_;
  std::vector<double> once_;   ///< Integral up to each knot: count_ per knot.
  std::vector<double> twice_;  ///< Integral of that integral, same layout.
};

}  // namespace marey::dynamics
