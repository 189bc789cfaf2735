// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/base/time.h"

namespace marey::dynamics {

/// Times of a flight after the first frame. [s] Both are given: positions do not
/// determine them, since a push ends gradually.
struct FlightTimes {
  double takeoff_s = 0.0;
  double landing_s = 0.0;
};

/// A parabola through a flight: position and velocity at take-off, and gravity.
struct FlightFit {
  double takeoff_s = 0.0;
  glm::dvec3 p_in_world{0.0};    ///< Centre of mass at take-off. [m]
  glm::dvec3 velocity_m_s{0.0};  ///< At take-off.
  double gravity_m_s2 = 0.0;     ///< Downwards, positive.
  double rms_m = 0.0;            ///< Distance of the frames from the parabola.
  int frames = 0;                ///< Frames fitted.

  [[nodiscard]] glm::dvec3 position_at(double time_s) const {
    const double t = time_s - takeoff_s;
    return p_in_world + velocity_m_s * t -
           glm::dvec3(0.0, 0.5 * gravity_m_s2 * t * t, 0.0);
  }
  [[nodiscard]] glm::dvec3 velocity_at(double time_s) const {
    return velocity_m_s - glm::dvec3(0.0, gravity_m_s2 * (time_s - takeoff_s), 0.0);
  }
};

/// Frames further than this from the parabola count less (Huber): above the wobble of a
/// marker model's centre of mass, 2.5 mm.
inline constexpr double kFlightOutlier_m = 0.005;

/// Fits position and velocity, two unknowns an axis, to all frames within the times, with
/// gravity known: least squares, with frames beyond `outlier_m` weighted by Huber's rule
/// on their distance from the parabola. The answer does not depend on the heading. Linear
/// in frames. nullopt: fewer than 2 frames.
/// Preconditions: rate above 0, gravity finite, positions finite, outlier_m above 0.
[[nodiscard]] std::optional<FlightFit> fit_flight(
    std::span<const glm::dvec3> com_in_world,
    FrameRate rate,
    const FlightTimes& times,
    double gravity_m_s2,
    double outlier_m = kFlightOutlier_m);

/// Vertical acceleration of the frames within the times, upwards (-9.81 in free flight),
/// by the same fit with the acceleration as the third unknown. nullopt: fewer than 4
/// frames. Preconditions: as above.
[[nodiscard]] std::optional<double> fit_fall_m_s2(
    std::span<const glm::dvec3> com_in_world,
    FrameRate rate,
    const FlightTimes& times,
    double outlier_m = kFlightOutlier_m);

}  // namespace marey::dynamics
