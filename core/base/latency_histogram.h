// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace marey {

/// Histogram of repeated durations: quantiles to 2 percent of their value, from a
/// microsecond to minutes, in constant memory.
class LatencyHistogram {
 public:
  void add(double duration_s) {
    ++bins_[bin_of(duration_s)];
    ++count_;
    max_s_ = std::max(max_s_, duration_s);
  }
  void clear() { *this = LatencyHistogram(); }

  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] double max_s() const { return max_s_; }
  /// Returns the duration that this share of all durations does not exceed; 0 if there
  /// are none.
  /// Precondition: 0 <= share <= 1.
  [[nodiscard]] double quantile_s(double share) const {
    const auto wanted =
        static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_)));
    std::int64_t below = 0;
    for (std::size_t b = 0; b < bins_.size(); ++b) {
      below += bins_[b];
      if (below > 0 && below >= wanted) return std::min(end_s(b), max_s_);
    }
    return 0.0;
  }

 private:
  static constexpr double kMin_s = 1e-6;
  static constexpr double kStep = 1.02;
  static constexpr std::size_t kBins = 1000;  // Up to 1.02^1000 us: 400 s.

  static std::size_t bin_of(double duration_s) {
    if (!(duration_s > kMin_s)) return 0;
    const double bin = std::ceil(std::log(duration_s / kMin_s) / std::log(kStep));
    return std::min(static_cast<std::size_t>(bin), kBins - 1);
  }
  static double end_s(std::size_t bin) {
    return kMin_s * std::pow(kStep, static_cast<double>(bin));
  }

  std::array<std::int64_t, kBins> bins_{};
  std::int64_t count_ = 0;
  double max_s_ = 0.0;
};

}  // namespace marey
