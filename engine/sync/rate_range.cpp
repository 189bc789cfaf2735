// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/rate_range.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace marey::engine {
namespace {

/// Ends of the parts of [0, 1] in which a cubic is monotone: 0, the roots of its
/// derivative q0 + q1 x + q2 x^2 in between, 1.
std::array<double, 4> monotone_parts(double q0, double q1, double q2) {
  std::array<double, 4> x{0.0, 0.0, 1.0, 1.0};
  const double discriminant = q1 * q1 - 4.0 * q0 * q2;
  if (discriminant < 0.0) return x;
  // Without cancellation.
  const double s = -0.5 * (q1 + std::copysign(std::sqrt(discriminant), q1));
  if (q2 != 0.0) x[1] = std::clamp(s / q2, 0.0, 1.0);
  if (s != 0.0) x[2] = std::clamp(q0 / s, 0.0, 1.0);
  if (x[1] > x[2]) std::swap(x[1], x[2]);
  return x;
}

}  // namespace

RateRange rate_range(const std::array<double, 6>& c, double length_s) {
  const auto rate = [&](double x) {
    return c[1] + x * (2.0 * c[2] + x * (3.0 * c[3] + x * (4.0 * c[4] + x * 5.0 * c[5])));
  };
  const auto slope = [&](double x) {
    return 2.0 * c[2] + x * (6.0 * c[3] + x * (12.0 * c[4] + x * 20.0 * c[5]));
  };
  double low = std::min(rate(0.0), rate(1.0));
  double high = std::max(rate(0.0), rate(1.0));
  const auto include = [&](double x) {
    low = std::min(low, rate(x));
    high = std::max(high, rate(x));
  };
  const auto parts = monotone_parts(6.0 * c[3], 24.0 * c[4], 60.0 * c[5]);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    double a = parts[i - 1];
    double b = parts[i];
    include(a);
    if ((slope(a) < 0.0) == (slope(b) < 0.0)) continue;
    const bool falls_first = slope(a) < 0.0;
    // An error of 2^-30 in x changes the extremum by 2^-60.
    for (int step = 0; step < 30; ++step) {
      const double middle = 0.5 * (a + b);
      ((slope(middle) < 0.0) == falls_first ? a : b) = middle;
    }
    include(0.5 * (a + b));
  }
  return {low / length_s, high / length_s};
}

}  // namespace marey::engine
