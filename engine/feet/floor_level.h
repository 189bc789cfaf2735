// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace marey::engine {

/// Vertical displacement of a whole blend by which its bearing feet reach the floor: the
/// floor of a recording is often some centimetres off, and drifts. It follows the feet
/// like a critically damped spring, so that its velocity has no jumps, and keeps its
/// value in flights. Allocates nothing.
class FloorLevel {
 public:
  /// Time constant. [s]
  static constexpr double kTime_s = 0.06;

  void reset() { *this = FloorLevel(); }

  /// Returns the displacement after a step [m]. `sole_height_m`: height of the lowest
  /// bearing sole of the blend above the floor, without this displacement; nullopt: no
  /// foot bears. A foot whose sole is still more than `max_m` from the floor after the
  /// displacement does not count. A foot that bears in the first step is met at once.
  /// Precondition: step_s > 0.
  double step(std::optional<double> sole_height_m, double max_m, double step_s);

  [[nodiscard]] double lift_m() const { return lift_m_; }

 private:
  bool is_known_ = false;
  double lift_m_ = 0.0;
  double rate_m_s_ = 0.0;
};

}  // namespace marey::engine
