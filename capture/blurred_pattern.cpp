// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/blurred_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace marey::capture {

void weigh_cells(double place, double sigma, int cells, CellWeights& out) {
  constexpr double kReach = 4.0;
  const auto cell_at = [&](double x) {
    return static_cast<int>(std::clamp(std::floor(x), 0.0, cells - 1.0));
  };
  out.first = cell_at(place - kReach * sigma);
  const int last = cell_at(place + kReach * sigma);
  out.count = std::min(last - out.first + 1, CellWeights::kMost);
  double below = 0.0;
  double slope_below = 0.0;
  double spread_below = 0.0;
  for (int i = 0; i < out.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    double above = 1.0;
    double slope = 0.0;
    double spread = 0.0;
    if (i + 1 < out.count) {
      const double z = (out.first + i + 1 - place) / sigma;
      above = 0.5 * std::erfc(-z / std::numbers::sqrt2);
      slope = std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
      spread = slope * z;
    }
    out.weight[k] = above - below;
    out.by_place[k] = -(slope - slope_below) / sigma;
    out.by_log_sigma[k] = -(spread - spread_below);
    below = above;
    slope_below = slope;
    spread_below = spread;
  }
}

Blurred blurred(const TagPattern& pattern, const CellWeights& u, const CellWeights& v) {
  Blurred sum;
  for (int j = 0; j < v.count; ++j) {
    double row = 0.0;
    double row_by_u = 0.0;
    double row_by_sigma = 0.0;
    const std::size_t line =
        static_cast<std::size_t>(v.first + j) * static_cast<std::size_t>(pattern.cells) +
        static_cast<std::size_t>(u.first);
    for (std::size_t i = 0; i < static_cast<std::size_t>(u.count); ++i) {
      if (pattern.white[line + i] == 0) continue;
      row += u.weight[i];
      row_by_u += u.by_place[i];
      row_by_sigma += u.by_log_sigma[i];
    }
    const auto k = static_cast<std::size_t>(j);
    sum.value += v.weight[k] * row;
    sum.by_u += v.weight[k] * row_by_u;
    sum.by_v += v.by_place[k] * row;
    sum.by_log_sigma += v.weight[k] * row_by_sigma + v.by_log_sigma[k] * row;
  }
  return sum;
}

}  // namespace marey::capture
