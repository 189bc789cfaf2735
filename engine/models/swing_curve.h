// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace marey::engine {

/// A value over time with its derivatives.
struct CurvePoint {
  double value = 0.0;
  double rate = 0.0;
  double acceleration = 0.0;
};

/// A value that is led to targets by quintics, each from the value, rate and acceleration
/// of the one before, and to rest: C2 whatever the targets do.
class SwingCurve {
 public:
  /// Rests at a value.
  void hold(double value);
  /// From `now_s` on leads to rest at `target` at `end_s`. Precondition: end_s > now_s.
  void bend(double now_s, double end_s, double target);

  [[nodiscard]] CurvePoint at(double time_s) const;
  [[nodiscard]] double end_s() const { return start_s_ + length_s_; }
  [[nodiscard]] double target() const { return target_; }

 private:
  double start_s_ = 0.0;
  double length_s_ = 0.0;  ///< 0: at rest.
  double target_ = 0.0;
  std::array<double, 6> c_{};  ///< By powers of (time - start) / length.
};

/// Targets from low to high.
struct CurveRange {
  double low = 0.0;
  double high = 0.0;
};

/// Returns the targets that a curve from `from` may have so that it keeps within
/// +-max_value and +-max_rate on its way; empty (low > high) if there are none. The range
/// is exact to 1 % of the limits. Precondition: length_s > 0.
[[nodiscard]] CurveRange permitted_targets(const CurvePoint& from,
                                           double length_s,
                                           double max_value,
                                           double max_rate);

}  // namespace marey::engine
