// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/vec3.hpp>

namespace marey::engine {

/// A value over time at an instant, with its first two derivatives.
struct Motion3 {
  glm::dvec3 value{0.0};
  glm::dvec3 rate{0.0};
  glm::dvec3 acceleration{0.0};
};

/// A polynomial of degree five over [start_s, start_s + length_s]: the only one with
/// given values, rates and accelerations at both ends, and of all such curves the one
/// with the least mean squared jerk (Flash & Hogan 1985).
struct QuinticLeg {
  double start_s = 0.0;
  double length_s = 1.0;
  std::array<glm::dvec3, 6> c{};  ///< By powers of (time - start_s) / length_s.

  [[nodiscard]] double end_s() const { return start_s + length_s; }
  /// Returns the motion at a time; beyond the ends the polynomial continues.
  [[nodiscard]] Motion3 at(double time_s) const;
  /// Returns the maximum of the acceleration's length, at 17 instants: 1 % below the
  /// exact maximum between two places at rest.
  [[nodiscard]] double max_acceleration() const;
};

/// Returns the leg between two motions. Precondition: length_s > 0.
[[nodiscard]] QuinticLeg quintic_leg(double start_s,
                                     double length_s,
                                     const Motion3& from,
                                     const Motion3& to);

}  // namespace marey::engine
