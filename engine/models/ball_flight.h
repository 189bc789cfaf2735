// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec3.hpp>

namespace marey::engine {

struct BallOptions {
  double gravity_m_s2 = 9.81;  ///< Downwards, along -Y.
  /// Deceleration by drag is drag_1_m * speed^2: density * coefficient * area / (2 *
  /// mass). A handball has about 0.011.
  double drag_1_m = 0.0;
  double max_time_s = 10.0;
};

/// A ball in flight at an instant.
struct BallState {
  double time_s = 0.0;  ///< Since the release.
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 velocity_m_s{0.0};
};

/// Returns the ball at a time after the release. Exact without drag; with it by steps of
/// one millisecond (Runge-Kutta of fourth order; error below 1e-6 m a second at 30 m/s).
/// Precondition: time_s in [0, max_time_s].
[[nodiscard]] BallState ball_at(const glm::dvec3& p_in_world,
                                const glm::dvec3& velocity_m_s,
                                double time_s,
                                const BallOptions& options = {});

struct BallPlane {
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< Not zero; any length and sign.
};

/// Returns the first arrival in a plane, after the release; nullopt: it does not arrive
/// within max_time_s.
[[nodiscard]] std::optional<BallState> ball_arrival(const glm::dvec3& p_in_world,
                                                    const glm::dvec3& velocity_m_s,
                                                    const BallPlane& plane,
                                                    const BallOptions& options = {});

/// A direction in which a ball of given speed meets a point.
struct BallAim {
  glm::dvec3 direction_in_world{0.0};  ///< Unit.
  /// As ThrowParameters for heading 0.
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  double time_s = 0.0;  ///< For flight.
};

enum class BallArc { kFlat, kSteep };

/// Computes how to throw from a place at a speed so that the ball meets `point_in_world`:
/// the flatter of both solutions, or the steeper. With drag the elevation is refined
/// until the ball passes within 0.1 mm. nullopt: out of range; numbers that are not
/// finite; speed not above 0. A point right above the release has one direction, its
/// azimuth 0.
[[nodiscard]] std::optional<BallAim> aim_ball(const glm::dvec3& from_in_world,
                                              const glm::dvec3& point_in_world,
                                              double speed_m_s,
                                              const BallOptions& options = {},
                                              BallArc arc = BallArc::kFlat);

}  // namespace marey::engine
