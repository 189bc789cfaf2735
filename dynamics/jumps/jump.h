// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/finding.h"
#include "core/source.h"

namespace marey::dynamics {

/// Beginning of a push.
enum class PushStart {
  kStanding,   ///< The body stood still.
  kTouchdown,  ///< A flight ended: drop jump, hop, running step.
  kMoving,     ///< The last highest point before the lowest one.
  kClipStart,  ///< The clip begins during the push.
  kGiven,      ///< Set by the caller.
};

/// State of the centre of mass at one instant.
struct ComState {
  double time_s = 0.0;  ///< Since the first pose.
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 velocity_m_s{0.0};
};

/// A jump: a push, a flight and a landing (Kulpa 2005, 6.2: P1 to P3; P4 and P5 are
/// ours). Heights are world Y.
struct Jump {
  PushStart start_kind = PushStart::kStanding;
  ComState start;         ///< P1: start of the push.
  double lowest_s = 0.0;  ///< P2: lowest point of the push.
  double lowest_m = 0.0;
  ComState takeoff;  ///< P3. From the fit of the whole flight.
  double apex_s = 0.0;
  double apex_m = 0.0;
  /// P4, from the same fit. nullopt: the clip ends in flight.
  std::optional<ComState> touchdown{};
  /// P5: the body is at rest, or leaves the floor again (then it is the next take-off).
  /// nullopt: the clip ends before.
  std::optional<ComState> rest{};
  bool rest_is_takeoff = false;

  /// kMeasured: feet and acceleration of the centre of mass agree within 40 ms.
  /// kInferred: they do not, or the feet are unknown: the acceleration's.
  Source takeoff_source = Source::kInferred;
  Source landing_source = Source::kInferred;
  /// Middle of the soles that bear last, and first, at the height of their lowest point:
  /// on the floor. Without soles: below the centre of mass, at height 0.
  glm::dvec3 takeoff_feet_in_world{0.0};
  std::optional<glm::dvec3> landing_feet_in_world{};

  /// Acceleration of a free fit of the flight, upwards: -9.81 without errors; and of its
  /// rising and falling part (0: fewer than 4 frames).
  double fall_m_s2 = 0.0;
  double fall_rising_m_s2 = 0.0;
  double fall_falling_m_s2 = 0.0;
  /// Gravity of the fitted parabola: the expected one, or the captured one if that
  /// differs by more than 1 m/s^2, and by enough to be measured in a flight this short
  /// (5 mm at its middle).
  double gravity_m_s2 = 0.0;
  double flight_rms_m = 0.0;  ///< Distance of the flight's frames from the parabola.
  std::vector<Finding> findings;

  /// Rise of the centre of mass above its height at take-off. [m]
  [[nodiscard]] double rise_m() const { return apex_m - takeoff.p_in_world.y; }
};

}  // namespace marey::dynamics
