// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/spline_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/assert.h"

namespace marey {
namespace {

constexpr int kCurveMaxOrder = 6;

/// c_k of f^(m); 0 outside, where a natural spline is a polynomial of degree m - 1.
double curve_top(std::span<const double> c, std::ptrdiff_t k) {
  const bool inside = k >= 0 && k < static_cast<std::ptrdiff_t>(c.size());
  return inside ? c[static_cast<std::size_t>(k)] : 0.0;
}

/// B-spline coefficients b at the samples: g = b + delta^2 b / 6 for the cubic, where g
/// are the fitted values and delta^2 b_i = c_(i-1).
void cubic_curve(std::span<const double> g,
                 std::span<const double> c,
                 std::span<double> b) {
  const auto samples = static_cast<std::ptrdiff_t>(g.size());
  for (std::ptrdiff_t i = 0; i < samples; ++i) {
    const auto at = static_cast<std::size_t>(i);
    b[at + 1] = g[at] - curve_top(c, i - 1) / 6.0;
  }
  b[0] = 2.0 * b[1] - b[2];
  b[b.size() - 1] = 2.0 * b[b.size() - 2] - b[b.size() - 3];
}

/// The same for the quintic: g = b + delta^2 b / 4 + delta^4 b / 120, where delta^4 b_i =
/// c_(i-1) - c_(i-2). All terms are local, so no error accumulates along the samples.
void quintic_curve(std::span<const double> g,
                   std::span<const double> c,
                   std::span<double> b) {
  const auto samples = static_cast<std::ptrdiff_t>(g.size());
  for (std::ptrdiff_t i = 1; i + 1 < samples; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double delta4 = curve_top(c, i - 1) - curve_top(c, i - 2);
    const double delta6 = curve_top(c, i) - 3.0 * curve_top(c, i - 1) +
                          3.0 * curve_top(c, i - 2) - curve_top(c, i - 3);
    const double delta2 =
        (g[at + 1] - 2.0 * g[at] + g[at - 1]) - delta4 / 4.0 - delta6 / 120.0;
    b[at + 2] = g[at] - delta2 / 4.0 - delta4 / 120.0;
  }
  // Outwards by third differences: Delta^3 b_k = c_k.
  for (std::ptrdiff_t k = 0; k >= -2; --k) {
    const auto at = static_cast<std::size_t>(k + 2);
    b[at] = b[at + 3] - 3.0 * b[at + 2] + 3.0 * b[at + 1] - curve_top(c, k);
  }
  for (std::ptrdiff_t k = samples - 4; k <= samples - 2; ++k) {
    const auto at = static_cast<std::size_t>(k + 2);
    b[at + 3] = curve_top(c, k) + 3.0 * b[at + 2] - 3.0 * b[at + 1] + b[at];
  }
}

/// Values of the `order` B-splines of that order that are not 0 at the fraction u of an
/// interval (de Boor 1978, uniform knots).
std::array<double, kCurveMaxOrder> curve_basis(int order, double u) {
  std::array<double, kCurveMaxOrder> basis{};
  basis[0] = 1.0;
  for (int k = 1; k < order; ++k) {
    double saved = 0.0;
    for (int j = 0; j < k; ++j) {
      const auto at = static_cast<std::size_t>(j);
      const double share = basis[at] / k;
      basis[at] = saved + (static_cast<double>(j + 1) - u) * share;
      saved = (u + static_cast<double>(k - 1 - j)) * share;
    }
    basis[static_cast<std::size_t>(k)] = saved;
  }
  return basis;
}

}  // namespace

SplineCurve::SplineCurve(SmoothingSpline& spline,
                         std::span<const double> channel,
                         double rate_hz)
    : order_(spline.options().order),
      rate_hz_(rate_hz),
      end_s_(static_cast<double>(channel.size() - 1) / rate_hz) {
  MAREY_ASSERT(rate_hz > 0.0);
  std::vector<double> fitted(channel.size());
  static_cast<void>(spline.fit(channel, fitted));
  coefficients_.resize(channel.size() + 2 * (static_cast<std::size_t>(order_) - 1));
  if (order_ == 2) {
    cubic_curve(fitted, spline.top_derivative(), coefficients_);
  } else {
    quintic_curve(fitted, spline.top_derivative(), coefficients_);
  }
}

double SplineCurve::at(double time_s, int derivative) const {
  MAREY_ASSERT(derivative >= 0 && derivative < 2 * order_);
  MAREY_ASSERT(time_s >= -1e-9 && time_s <= end_s_ + 1e-9);
  const double x = time_s * rate_hz_;
  const auto support = 2 * static_cast<std::size_t>(order_);
  const auto last = static_cast<double>(coefficients_.size() - support);
  const double interval = std::clamp(std::floor(x), 0.0, last);
  // The splines centred from interval - (m - 1) to interval + m.
  std::array<double, kCurveMaxOrder> local{};
  std::copy_n(coefficients_.begin() + static_cast<std::ptrdiff_t>(interval),
              support,
              local.begin());
  double scale = 1.0;
  for (int d = 0; d < derivative; ++d) {
    for (std::size_t j = 0; j + 1 + static_cast<std::size_t>(d) < support; ++j) {
      local[j] = local[j + 1] - local[j];
    }
    scale *= rate_hz_;
  }
  const int order = 2 * order_ - derivative;
  const auto basis = curve_basis(order, x - interval);
  double value = 0.0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(order); ++j) {
    value += basis[j] * local[j];
  }
  return value * scale;
}

}  // namespace marey
