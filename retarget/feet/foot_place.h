// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey::retarget {

/// Position and rotations of one foot at one instant.
struct FootPlace {
  glm::dvec3 ankle_in_world{0.0};  ///< [m]
  /// T-pose-relative world rotations: a turn about Y is a foot flat on the floor.
  glm::dquat foot{1.0, 0.0, 0.0, 0.0};
  glm::dquat toes{1.0, 0.0, 0.0, 0.0};
};

}  // namespace marey::retarget
