// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/time.h"

namespace marey {

/// Points of one sole over a motion, one per frame, in the world. [m]
struct SoleTrack {
  std::vector<glm::dvec3> heel_in_world;  ///< Rear end.
  std::vector<glm::dvec3> ball_in_world;  ///< Below the toe joint.
  std::vector<glm::dvec3> tip_in_world;   ///< Front end, below the tip of the toes.
};

/// Centre of mass and soles of a body over a motion: the input of dynamics. Frame i is at
/// time i / rate after the first pose.
struct BodyTrack {
  FrameRate rate;
  double mass_kg = 0.0;
  std::vector<glm::dvec3> com_in_world;  ///< [m]
  std::array<SoleTrack, 2> soles;        ///< Left, right. Empty: feet are unknown.
};

}  // namespace marey
