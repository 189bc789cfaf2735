// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/floor.h"
#include "retarget/feet/floor_at.h"

namespace marey::engine {

/// Displacement of a foot from the level floor at height 0 to another floor.
struct FloorShift {
  glm::dvec3 moved_m{0.0};  ///< For the ankle.
  /// To apply to the foot's rotation in the world.
  glm::dquat turn{1.0, 0.0, 0.0, 0.0};
  /// Displacement of the part under the foot since the start, while it stood there. [m]
  glm::dvec3 carried_m{0.0};
};

/// Carries the feet of one character on an uneven or moving floor (Kulpa 2005, 4.2.4 and
/// figure 7.5). A standing foot moves with the part on which its ankle stood first; one
/// that does not stand follows the other foot. Allocates nothing.
class FloorRide {
 public:
  struct Foot {
    bool stands = false;
    glm::dvec3 ankle_in_level{0.0};  ///< On the level floor. [m]
    double ankle_height_m = 0.0;     ///< Above the sole.
  };
  /// Computes the shifts of both feet at time_s, step_s after the last call.
  /// Preconditions: step_s > 0; the floor is that of the last call.
  std::array<FloorShift, 2> step(const Floor& floor,
                                 double time_s,
                                 double step_s,
                                 const std::array<Foot, 2>& feet);

 private:
  struct Ride {
    bool stood = false;
    FloorPartIndex part;
    glm::dvec3 part_moved_m{0.0};  ///< By moved_at(), in the last step.
    glm::dvec3 carried_m{0.0};
    /// Height and normal from which a landing foot comes, minus those of its part.
    double rest_m = 0.0;
    retarget::FloorSpot spot;
  };
  bool is_known_ = false;
  std::array<Ride, 2> rides_{};
};

}  // namespace marey::engine
