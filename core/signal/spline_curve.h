// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/signal/smoothing_spline.h"

namespace marey {

/// A fitted smoothing spline as a function of time: values and derivatives between the
/// samples, for resampling and for slowing a motion down.
class SplineCurve {
 public:
  /// Fits `channel` with the penalty that `spline` has. Linear in the samples.
  /// Preconditions: those of SmoothingSpline::fit(); rate_hz > 0.
  SplineCurve(SmoothingSpline& spline, std::span<const double> channel, double rate_hz);

  /// Time of the last sample; the first is at 0. [s]
  [[nodiscard]] double end_s() const { return end_s_; }

  /// Returns a derivative of the spline: 0 is its value, 1 per second, 2 per second
  /// squared. Constant cost, no allocation.
  /// Preconditions: 0 <= derivative < 2 * order; time from 0 to end_s(), with 1e-9 s of
  /// tolerance.
  [[nodiscard]] double at(double time_s, int derivative = 0) const;

 private:
  int order_;
  double rate_hz_;
  double end_s_;
  /// Coefficients of the centred B-splines of order 2m at -(m - 1) to n - 1 + m - 1.
  std::vector<double> coefficients_;
};

}  // namespace marey
