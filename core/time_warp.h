// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace marey {

/// A pair of times that a warp matches.
struct WarpKnot {
  double time_s = 0.0;    ///< In the result.
  double source_s = 0.0;  ///< In the source.
};

/// A monotone map of times with continuous speed and acceleration that meets all knots.
/// Between two knots it is the quintic with these speeds and no acceleration at both:
/// with x = (t - t0) / h and the mean speed d of the interval,
///   s0 + m0 h (x - 6x^3 + 8x^4 - 3x^5) + m1 h (-4x^3 + 7x^4 - 3x^5)
///      + d h (10x^3 - 15x^4 + 6x^5).
/// The speed at a knot is the harmonic mean of the mean speeds on both sides, at most
/// twice the smaller one; the quintic is monotone up to 2.14 times. Knots on a line give
/// the line. Beyond the first and the last knot the speed there continues.
class TimeWarp {
 public:
  /// `outer_speed` is the speed at the first and at the last knot, and beyond; nullopt:
  /// the mean speed of the interval there. It is at most 2.1 times that.
  /// Precondition: at least one knot; both times ascend strictly. One knot: speed 1.
  explicit TimeWarp(std::span<const WarpKnot> knots,
                    std::optional<double> outer_speed = std::nullopt);

  /// Returns the source time. Logarithmic in knots.
  [[nodiscard]] double source_s(double time_s) const;
  /// Returns its derivative: above 0.
  [[nodiscard]] double speed(double time_s) const;

 private:
  struct Place;
  [[nodiscard]] Place find(double time_s) const;

  std::vector<WarpKnot> knots_;
  std::vector<double> speed_;  ///< At each knot.
};

}  // namespace marey
