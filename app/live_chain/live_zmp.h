// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace marey::app {

/// Estimates the zero moment point of a live body, from its centre of mass alone
/// (cart-table model, docs/jumps.md): without future poses and without angular momentum.
/// The acceleration is that of the parabola of least squares through the last kWindow_s,
/// so it lags by half of them: 0.1 s. Noise of 1 mm at 60 Hz moves the point by about 20
/// mm. For display; recordings have the exact one. Allocates nothing.
class LiveZmp {
 public:
  static constexpr double kWindow_s = 0.2;

  /// Adds the next centre of mass. Precondition: since_last_s > 0.
  void step(const glm::dvec3& com_in_world, double since_last_s);
  /// Forgets all positions.
  void reset() { count_ = 0; }
  /// Returns the point on the floor, world X and Z. nullopt: fewer than 5 positions or
  /// less than half a window since the reset, or a push below 0.2 g (flight).
  [[nodiscard]] std::optional<glm::dvec2> on_floor(double floor_height_m) const;

 private:
  struct Sample {
    double age_s = 0.0;  ///< Since then, at the newest one.
    glm::dvec3 com_in_world{0.0};
  };
  /// Newest first. At higher rates, the window is shorter.
  std::array<Sample, 64> samples_{};
  std::size_t count_ = 0;
};

}  // namespace marey::app
