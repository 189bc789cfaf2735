// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/cubic_spline.h"

#include <algorithm>
#include <cstddef>

#include "core/base/assert.h"

namespace marey {

CubicSpline::CubicSpline(std::span<const double> knots,
                         std::span<const double> values,
                         std::optional<double> start_slope)
    : knots_(knots.begin(), knots.end()),
      values_(values.begin(), values.end()),
      bends_(knots.size(), 0.0) {
  MAREY_ASSERT(knots.size() >= 2 && values.size() == knots.size());
  const std::size_t n = knots_.size();
  // Tridiagonal system for the second derivatives, solved by Thomas' algorithm.
  std::vector<double> factor(n, 0.0);
  const auto width = [&](std::size_t i) { return knots_[i + 1] - knots_[i]; };
  const auto slope = [&](std::size_t i) {
    return (values_[i + 1] - values_[i]) / width(i);
  };
  if (start_slope) {
    factor[0] = 0.5;
    bends_[0] = 3.0 * (slope(0) - *start_slope) / width(0);
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = width(i - 1);
    const double after = width(i);
    const double pivot = 2.0 * (before + after) - before * factor[i - 1];
    factor[i] = after / pivot;
    bends_[i] = (6.0 * (slope(i) - slope(i - 1)) - before * bends_[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 0;) bends_[i] -= factor[i] * bends_[i + 1];
}

std::size_t CubicSpline::piece_of(double x) const {
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, x);
  return static_cast<std::size_t>(after - knots_.begin()) - 1;
}

double CubicSpline::at(double x) const {
  if (x < knots_.front()) {
    return values_.front() + (x - knots_.front()) * slope_at(knots_.front());
  }
  if (x > knots_.back()) {
    return values_.back() + (x - knots_.back()) * slope_at(knots_.back());
  }
  const std::size_t i = piece_of(x);
  const double width = knots_[i + 1] - knots_[i];
  const double b = (x - knots_[i]) / width;
  const double a = 1.0 - b;
  return a * values_[i] + b * values_[i + 1] +
         (a * (a * a - 1.0) * bends_[i] + b * (b * b - 1.0) * bends_[i + 1]) * width *
             width / 6.0;
}

double CubicSpline::slope_at(double x) const {
  x = std::clamp(x, knots_.front(), knots_.back());
  const std::size_t i = piece_of(x);
  const double width = knots_[i + 1] - knots_[i];
  const double b = (x - knots_[i]) / width;
  const double a = 1.0 - b;
  return (values_[i + 1] - values_[i]) / width +
         ((3.0 * b * b - 1.0) * bends_[i + 1] - (3.0 * a * a - 1.0) * bends_[i]) * width /
             6.0;
}

}  // namespace marey
