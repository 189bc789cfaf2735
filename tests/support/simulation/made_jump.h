// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/human/body_track.h"

namespace marey::testing {

/// One flight of a made sequence. Lengths and speeds are those of an adult of 1.75 m;
/// other bodies scale them (lengths by stature, times by its root).
struct MadeFlight {
  double up_m_s = 2.4;     ///< Vertical speed at take-off.
  double ahead_m_s = 0.0;  ///< Horizontal speed, along +Z.
  double box_m = 0.0;      ///< Height of the next floor above this one.
  double squat_m = 0.25;   ///< Depth of the push below standing.
  double push_s = 0.30;    ///< From the lowest point to take-off.
};

struct MadeJumpOptions {
  double stature_m = 1.75;
  double rate_hz = 120.0;
  double gravity_m_s2 = 9.81;
  double standing_s = 0.5;  ///< Before the first push and after the last landing.
  double noise_m = 0.0;     ///< Standard deviation per axis, of every point.
  std::uint64_t seed = 1;
  bool one_footed = false;  ///< The right foot hangs behind the body.
  bool somersault = false;  ///< The feet turn once about the centre of mass in flight.
  double first_floor_m = 0.0;
};

/// Exact truth of one flight.
struct MadeFlightTruth {
  double lowest_s = 0.0;
  double lowest_m = 0.0;
  double takeoff_s = 0.0;
  double landing_s = 0.0;
  glm::dvec3 takeoff_in_world{0.0};
  glm::dvec3 takeoff_m_s{0.0};
  glm::dvec3 landing_in_world{0.0};
  glm::dvec3 landing_m_s{0.0};
  double apex_m = 0.0;
  double floor_m = 0.0;  ///< Floor of the take-off.
  double landing_floor_m = 0.0;
};

struct MadeJump {
  BodyTrack track;
  std::vector<MadeFlightTruth> flights;
  double start_s = 0.0;  ///< The body stands until then.
  double rest_s = 0.0;   ///< The body stands from then on.
};

/// Builds a course of the centre of mass and of the soles: standing, a countermovement,
/// then the flights one after another; between two of them the landing is the next push.
/// The acceleration is piecewise linear: it changes to and from free fall over 30 to
/// 40 ms, and the force is never negative. Flights are parabolas. The heels rise before
/// take-off, the tips stay on the floor until it; the tips land first. All frames are
/// sampled from the exact curves.
[[nodiscard]] MadeJump made_jump(const std::vector<MadeFlight>& flights,
                                 const MadeJumpOptions& options = {});

/// A random sequence: a countermovement jump, a drop from a box followed by a jump, or a
/// series of two to four hops; 0.9 to 3 m/s upwards.
[[nodiscard]] std::vector<MadeFlight> random_flights(std::uint64_t seed);

}  // namespace marey::testing
