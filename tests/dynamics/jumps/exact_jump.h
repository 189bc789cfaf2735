// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dynamics/jumps/jump.h"
#include <glm/vec3.hpp>

#include "core/human/body_track.h"

namespace marey::dynamics::testing {

/// Parameters of a jump that is known exactly.
struct ExactJumpShape {
  double rate_hz = 120.0;
  double still_s = 0.4;  ///< Before the push and after the landing.
  double push_s = 0.7;
  double landing_s = 0.6;
  double stand_m = 1.0;  ///< Height of the standing centre of mass.
  double takeoff_m = 1.08;
  double touchdown_m = 1.05;
  double takeoff_m_s = 2.43;
  glm::dvec3 level_m_s{0.0};      ///< Horizontal velocity in flight; y is not used.
  glm::dvec3 from_in_world{0.0};  ///< Place of the feet before.
  double gravity_m_s2 = 9.81;
};

/// A jump from standing to standing and its exact phases: push and landing are
/// polynomials of degree 7 whose force is never negative, the flight is a parabola.
struct ExactJump {
  BodyTrack track;
  Jump jump;
};

[[nodiscard]] ExactJump make_exact_jump(const ExactJumpShape& shape = {});

}  // namespace marey::dynamics::testing
