// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/time.h"

namespace marey::dynamics {

/// Derivatives of a sampled curve by cubic polynomials that are fitted to windows
/// (Savitzky & Golay 1964). A window is centred on its frame; within half a window of the
/// ends it is the first or the last full window, and the polynomial is a parabola, whose
/// derivatives vary less with noise where it is evaluated off its centre.
/// A derivative is a weighted sum of samples, so the class also serves as a linear
/// operator.
class LocalCubic {
 public:
  /// `window_s` is the full width; a window has at least 5 samples, fewer if the curve
  /// has fewer. 3 or 4 samples: a parabola. Fewer: all derivatives are 0.
  /// Preconditions: rate above 0; window_s at least 0.
  LocalCubic(std::size_t frame_count, FrameRate rate, double window_s);

  [[nodiscard]] std::size_t frame_count() const { return frame_count_; }
  /// Returns the number of samples on each side of the centre of a window.
  [[nodiscard]] std::size_t half() const { return half_; }
  /// Returns the first sample of a frame's window. Precondition: the frame exists.
  [[nodiscard]] std::size_t first(std::size_t frame) const;
  /// Returns the weights of the samples of a frame's window, from first() on, of the
  /// first derivative. [1/s] Precondition: the frame exists.
  [[nodiscard]] std::span<const double> slope(std::size_t frame) const;
  /// Returns the weights of the second derivative. [1/s^2]
  [[nodiscard]] std::span<const double> curvature(std::size_t frame) const;

 private:
  [[nodiscard]] std::size_t row(std::size_t frame) const;

  std::size_t frame_count_ = 0;
  std::size_t half_ = 0;
  // One row of weights per position within a window.
  std::vector<double> slope_;
  std::vector<double> curvature_;
};

/// Returns the weighted sum of the samples of one window.
template <class Value>
[[nodiscard]] Value weighted_sum(std::span<const double> weights,
                                 std::span<const Value> samples,
                                 std::size_t first) {
  Value out{};
  for (std::size_t i = 0; i < weights.size(); ++i) out += weights[i] * samples[first + i];
  return out;
}

}  // namespace marey::dynamics
