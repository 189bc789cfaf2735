// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/swing_curve.h"

#include <algorithm>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

// Coefficients of the quintic in [0, 1] to rest at `target`.
std::array<double, 6> quintic_to_rest(const CurvePoint& from,
                                      double length_s,
                                      double target) {
  const double v = from.rate * length_s;
  const double a = from.acceleration * length_s * length_s;
  const double d = target - from.value;
  return {from.value,
          v,
          0.5 * a,
          10.0 * d - 6.0 * v - 1.5 * a,
          -15.0 * d + 8.0 * v + 1.5 * a,
          6.0 * d - 3.0 * v - 0.5 * a};
}

// Keeps the values `base + d * slope` within +-limit.
void narrow(CurveRange& range, double base, double slope, double limit) {
  if (slope < 1e-6) return;
  range.low = std::max(range.low, (-limit - base) / slope);
  range.high = std::min(range.high, (limit - base) / slope);
}

}  // namespace

void SwingCurve::hold(double value) {
  *this = {};
  target_ = value;
}

void SwingCurve::bend(double now_s, double end_s, double target) {
  MAREY_ASSERT(end_s > now_s);
  const CurvePoint from = at(now_s);
  start_s_ = now_s;
  length_s_ = end_s - now_s;
  target_ = target;
  c_ = quintic_to_rest(from, length_s_, target);
}

CurvePoint SwingCurve::at(double time_s) const {
  if (length_s_ <= 0.0 || time_s >= start_s_ + length_s_) return {target_, 0.0, 0.0};
  const double x = (time_s - start_s_) / length_s_;
  const auto& c = c_;
  CurvePoint out;
  out.value = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  out.rate =
      (c[1] + x * (2.0 * c[2] + x * (3.0 * c[3] + x * (4.0 * c[4] + x * 5.0 * c[5])))) /
      length_s_;
  out.acceleration =
      (2.0 * c[2] + x * (6.0 * c[3] + x * (12.0 * c[4] + x * 20.0 * c[5]))) /
      (length_s_ * length_s_);
  return out;
}

CurveRange permitted_targets(const CurvePoint& from,
                             double length_s,
                             double max_value,
                             double max_rate) {
  MAREY_ASSERT(length_s > 0.0);
  constexpr int kSamples = 24;
  // The curve of target 0 beyond its start, to which a target d adds d times smooth_step.
  const auto c = quintic_to_rest(from, length_s, from.value);
  CurveRange range{-2.0 * max_value, 2.0 * max_value};
  for (int i = 1; i <= kSamples; ++i) {
    const double x = static_cast<double>(i) / kSamples;
    const double value =
        c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
    const double rate =
        c[1] + x * (2.0 * c[2] + x * (3.0 * c[3] + x * (4.0 * c[4] + x * 5.0 * c[5])));
    const double rest = 1.0 - x;
    narrow(range, value, x * x * x * (10.0 + x * (6.0 * x - 15.0)), max_value);
    // Between two samples a rate exceeds both by less than 1 %.
    narrow(range, rate, 30.0 * x * x * rest * rest, 0.99 * max_rate * length_s);
  }
  return {range.low + from.value, range.high + from.value};
}

}  // namespace marey::engine
