// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

namespace marey::engine {

/// Moves the root of a blend towards the place that fits the standing feet, so that the
/// legs, and not the hips, need no correction: a critically damped spring. Allocates
/// nothing.
class RootPull {
 public:
  /// Time constant. [s]
  static constexpr double kTime_s = 0.06;

  void reset() { rate_m_s_ = glm::dvec2(0.0); }

  /// Returns the displacement of the root over a step [m]; world X and Z. `away_m`: the
  /// mean of the standing feet's places from those of the blend, 0 if none stands.
  [[nodiscard]] glm::dvec2 step(const glm::dvec2& away_m, double step_s);

 private:
  glm::dvec2 rate_m_s_{0.0};
};

}  // namespace marey::engine
