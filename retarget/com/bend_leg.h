// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey::retarget {

/// Thigh and shank of a posture, in world axes, prepared for bend_leg().
struct LegBones {
  glm::dvec3 up{0.0};            ///< From the knee to the hip. [m]
  glm::dvec3 down{0.0};          ///< From the knee to the ankle. [m]
  glm::dvec3 opening_axis{0.0};  ///< Unit; a positive turn of the shank opens the knee.
  double length_m = 0.0;         ///< Thigh plus shank.
  double reach_m = 0.0;          ///< From the hip to the ankle.
  // Dot product of thigh and shank, while the shank turns by an angle a about the axis:
  // offset + amplitude cos(a - phase).
  double offset_m2 = 0.0;
  double amplitude_m2 = 0.0;
  double phase_rad = 0.0;
};

/// Returns the bones of a leg. The knee opens about the normal of the leg's plane. A leg
/// that is straight within some degrees has no reliable plane: there the axis changes
/// smoothly to the knee's own hinge, and a knee that is stretched beyond straight bends
/// forward again. Precondition: both bones have a length; `hinge_in_world` is unit (see
/// LimbMap::hinge_in_t_pose).
[[nodiscard]] LegBones leg_bones(const glm::dvec3& hip_in_world,
                                 const glm::dvec3& knee_in_world,
                                 const glm::dvec3& ankle_in_world,
                                 const glm::dvec3& hinge_in_world);

/// Rotations in world axes that take a leg to another ankle.
struct LegTurns {
  glm::dquat thigh{1.0, 0.0, 0.0, 0.0};
  glm::dquat shank{1.0, 0.0, 0.0, 0.0};  ///< The thigh's turn included.
  /// Turn of the shank relative to the thigh: shank = thigh * knee.
  glm::dquat knee{1.0, 0.0, 0.0, 0.0};
};

/// Returns the turns after which the ankle is at `ankle_from_hip` (world axes): the knee
/// turns about the opening axis, then the leg turns by the smallest rotation. A distance
/// that the bones do not permit is clamped; the direction is kept. Closed form.
[[nodiscard]] LegTurns bend_leg(const LegBones& bones, const glm::dvec3& ankle_from_hip);

}  // namespace marey::retarget
