// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/blurred_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace marey::capture {

namespace {

// Beyond this many sigma, less than a thousandth of a blurred edge remains.
constexpr double kReach = 3.2;

/// The normal distribution and its density on a grid for linear interpolation: errors are
/// below 1e-6.
class NormalTable {
 public:
  struct At {
    double below = 0.0;    ///< Share below z.
    double density = 0.0;  ///< At z.
  };

  NormalTable() {
    for (std::size_t i = 0; i < knots_.size(); ++i) {
      const double z = static_cast<double>(i) / kPerSigma - kEnd;
      knots_[i] = {
          0.5 * std::erfc(-z / std::numbers::sqrt2),
          std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2};
    }
  }

  /// Precondition: |z| <= kEnd.
  [[nodiscard]] At at(double z) const {
    const double place = (z + kEnd) * kPerSigma;
    const auto knot = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(knot);
    const At& low = knots_[knot];
    const At& high = knots_[knot + 1];
    return {low.below + share * (high.below - low.below),
            low.density + share * (high.density - low.density)};
  }

  static constexpr double kEnd = 4.0;

 private:
  static constexpr double kPerSigma = 256.0;
  std::array<At, static_cast<std::size_t>(2 * kEnd * kPerSigma) + 2> knots_{};
};

const NormalTable kNormal;

}  // namespace

void weigh_cells(double place, double sigma, int cells, CellWeights& out) {
  static_assert(kReach < NormalTable::kEnd);
  const double last_cell = cells - 1.0;
  const double reach = kReach * sigma;
  out.first = static_cast<int>(std::clamp(place - reach, 0.0, last_cell));
  const int last = static_cast<int>(std::clamp(place + reach, 0.0, last_cell));
  out.count = std::min(last - out.first + 1, CellWeights::kMax);
  const double per_sigma = 1.0 / sigma;
  double below = 0.0;
  double slope_below = 0.0;
  double spread_below = 0.0;
  for (int i = 0; i < out.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    double above = 1.0;
    double slope = 0.0;
    double spread = 0.0;
    if (i + 1 < out.count) {
      const double z = std::clamp(
          (out.first + i + 1 - place) * per_sigma, -NormalTable::kEnd, NormalTable::kEnd);
      const NormalTable::At at = kNormal.at(z);
      above = at.below;
      slope = at.density;
      spread = slope * z;
    }
    out.weight[k] = above - below;
    out.by_place[k] = -(slope - slope_below) * per_sigma;
    out.by_log_sigma[k] = -(spread - spread_below);
    below = above;
    slope_below = slope;
    spread_below = spread;
  }
}

Blurred blurred(const TagPattern& pattern, const CellWeights& u, const CellWeights& v) {
  const auto cells = static_cast<std::size_t>(pattern.cells);
  const auto columns = static_cast<std::size_t>(u.count);
  const auto rows = static_cast<std::size_t>(v.count);
  const std::uint8_t* first = pattern.white.data() +
                              static_cast<std::size_t>(v.first) * cells +
                              static_cast<std::size_t>(u.first);
  std::size_t white = 0;
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) white += first[j * cells + i];
  }
  Blurred sum;
  if (white == 0 || white == rows * columns) {
    sum.value = white == 0 ? 0.0 : 1.0;
    sum.flat = true;
    return sum;
  }
  for (std::size_t j = 0; j < rows; ++j) {
    double row = 0.0;
    double row_by_u = 0.0;
    double row_by_sigma = 0.0;
    for (std::size_t i = 0; i < columns; ++i) {
      if (first[j * cells + i] == 0) continue;
      row += u.weight[i];
      row_by_u += u.by_place[i];
      row_by_sigma += u.by_log_sigma[i];
    }
    sum.value += v.weight[j] * row;
    sum.by_u += v.weight[j] * row_by_u;
    sum.by_v += v.by_place[j] * row;
    sum.by_log_sigma += v.weight[j] * row_by_sigma + v.by_log_sigma[j] * row;
  }
  return sum;
}

}  // namespace marey::capture
