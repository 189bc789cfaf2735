// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/force_splines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

using Cubic = ForceSplines::Cubic;

double knot_position(int index, int intervals) {
  return static_cast<double>(std::clamp(index - 3, 0, intervals));
}

/// Adds (constant + slope * u) * factor to `sum`. The degree of factor is at most 2.
void add_product(double constant, double slope, const Cubic& factor, Cubic& sum) {
  for (std::size_t i = 0; i < 4; ++i) {
    sum[i] += constant * factor[i];
    if (i < 3) sum[i + 1] += slope * factor[i];
  }
}

/// Computes spline `index` of `degree` on `interval` (Cox, de Boor).
Cubic spline_on_interval(int index, int degree, int interval, int intervals) {
  Cubic out{};
  const double start = knot_position(index, intervals);
  if (degree == 0) {
    const bool covers =
        start <= interval && knot_position(index + 1, intervals) >= interval + 1;
    if (covers) out[0] = 1.0;
    return out;
  }
  const double rise = knot_position(index + degree, intervals) - start;
  if (rise > 0.0) {
    const Cubic lower = spline_on_interval(index, degree - 1, interval, intervals);
    add_product((interval - start) / rise, 1.0 / rise, lower, out);
  }
  const double end = knot_position(index + degree + 1, intervals);
  const double fall = end - knot_position(index + 1, intervals);
  if (fall > 0.0) {
    const Cubic lower = spline_on_interval(index + 1, degree - 1, interval, intervals);
    add_product((end - interval) / fall, -1.0 / fall, lower, out);
  }
  return out;
}

double integral_of(const Cubic& c, double u) {
  return u * (c[0] + u * (c[1] / 2.0 + u * (c[2] / 3.0 + u * c[3] / 4.0)));
}

double double_integral_of(const Cubic& c, double u) {
  return u * u * (c[0] / 2.0 + u * (c[1] / 6.0 + u * (c[2] / 12.0 + u * c[3] / 20.0)));
}

}  // namespace

ForceSplines::ForceSplines(int count) : count_(count) {
  MAREY_ASSERT(count >= 4);
  for (int i = 0; i < intervals(); ++i) {
    for (int k = 0; k < 4; ++k) {
      cubics_.push_back(spline_on_interval(i + k, 3, i, intervals()));
    }
  }
  const auto size = static_cast<std::size_t>(count_);
  const double width = 1.0 / intervals();
  once_.assign(size * static_cast<std::size_t>(intervals() + 1), 0.0);
  twice_ = once_;
  for (int i = 0; i < intervals(); ++i) {
    const std::size_t from = size * static_cast<std::size_t>(i);
    for (std::size_t j = 0; j < size; ++j) {
      once_[from + size + j] = once_[from + j];
      twice_[from + size + j] = twice_[from + j] + width * once_[from + j];
    }
    for (int k = 0; k < 4; ++k) {
      const std::size_t at = from + size + static_cast<std::size_t>(i + k);
      once_[at] += width * integral_of(cubic(i, k), 1.0);
      twice_[at] += width * width * double_integral_of(cubic(i, k), 1.0);
    }
  }
}

ForceSplines::Place ForceSplines::place_of(double x) const {
  const double scaled = x * intervals();
  const int interval = std::clamp(static_cast<int>(scaled), 0, intervals() - 1);
  return {interval, scaled - interval};
}

void ForceSplines::write_values(double x, std::span<double> row) const {
  const auto [interval, u] = place_of(x);
  std::fill_n(row.begin(), count_, 0.0);
  for (int k = 0; k < 4; ++k) {
    const Cubic& c = cubic(interval, k);
    row[static_cast<std::size_t>(interval + k)] =
        c[0] + u * (c[1] + u * (c[2] + u * c[3]));
  }
}

void ForceSplines::write_integrals(double x, std::span<double> row) const {
  const auto [interval, u] = place_of(x);
  const auto from = static_cast<std::ptrdiff_t>(count_) * interval;
  std::copy_n(once_.begin() + from, count_, row.begin());
  for (int k = 0; k < 4; ++k) {
    row[static_cast<std::size_t>(interval + k)] +=
        integral_of(cubic(interval, k), u) / intervals();
  }
}

void ForceSplines::write_double_integrals(double x, std::span<double> row) const {
  const auto [interval, u] = place_of(x);
  const auto size = static_cast<std::size_t>(count_);
  const std::size_t from = size * static_cast<std::size_t>(interval);
  const double width = 1.0 / intervals();
  for (std::size_t j = 0; j < size; ++j) {
    row[j] = twice_[from + j] + u * width * once_[from + j];
  }
  for (int k = 0; k < 4; ++k) {
    row[static_cast<std::size_t>(interval + k)] +=
        width * width * double_integral_of(cubic(interval, k), u);
  }
}

std::vector<double> ForceSplines::roughness_matrix(double weight) const {
  const auto size = static_cast<std::size_t>(count_);
  std::vector<double> out(size * size, 0.0);
  const double width = 1.0 / intervals();
  const double bend_scale = weight / (width * width * width);
  for (int i = 0; i < intervals(); ++i) {
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; l < 4; ++l) {
        const Cubic& a = cubic(i, k);
        const Cubic& b = cubic(i, l);
        double product = 0.0;
        for (std::size_t m = 0; m < 4; ++m) {
          for (std::size_t n = 0; n < 4; ++n) {
            product += a[m] * b[n] / static_cast<double>(m + n + 1);
          }
        }
        const double bends =
            4.0 * a[2] * b[2] + 6.0 * (a[2] * b[3] + a[3] * b[2]) + 12.0 * a[3] * b[3];
        out[static_cast<std::size_t>(i + k) * size + static_cast<std::size_t>(i + l)] +=
            width * product + bend_scale * bends;
      }
    }
  }
  return out;
}

}  // namespace marey::dynamics
