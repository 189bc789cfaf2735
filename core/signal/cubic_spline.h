// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace marey {

/// The cubic spline through given values, with continuous first and second derivatives.
/// Both ends have no second derivative ("natural"), or the start has a given slope.
/// Beyond its ends it continues as a straight line.
class CubicSpline {
 public:
  /// Linear in knots. Preconditions: at least 2 knots, which ascend strictly; as many
  /// values.
  CubicSpline(std::span<const double> knots,
              std::span<const double> values,
              std::optional<double> start_slope = std::nullopt);

  /// Returns the value at `x`. Logarithmic in knots.
  [[nodiscard]] double at(double x) const;
  /// Returns the first derivative at `x`. Logarithmic in knots.
  [[nodiscard]] double slope_at(double x) const;

 private:
  /// Index of the piece that holds `x`.
  [[nodiscard]] std::size_t piece_of(double x) const;

  std::vector<double> knots_;
  std::vector<double> values_;
  std::vector<double> bends_;  ///< Second derivatives at the knots.
};

}  // namespace marey
