// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/models/quintic_leg.h"
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/transform.h"

namespace marey::engine {

/// A hand, or a point that is fixed in it (the palm), at an instant.
struct HandMotion {
  glm::dvec3 p_in_world{0.0};
  glm::dvec3 velocity_m_s{0.0};
  glm::dvec3 acceleration_m_s2{0.0};
  /// Rotation of the hand from the T-pose, in world axes.
  glm::dquat world_from_hand{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 turn_rad_s{0.0};  ///< Angular velocity, in world axes.
  glm::dvec3 turn_acceleration_rad_s2{0.0};
};

/// Returns the motion at the middle of three frames of a hand that are `step_s` apart, by
/// central differences. Rotations are those of world_from_hand. Precondition: step_s > 0.
[[nodiscard]] HandMotion hand_motion(const RigidTransform& before,
                                     const RigidTransform& now,
                                     const RigidTransform& after,
                                     double step_s);

/// Returns the motion at the last of three frames of a hand that are `step_s` apart, from
/// these alone: for instants at which the motion has a kink. Precondition: step_s > 0.
[[nodiscard]] HandMotion hand_motion_until(const RigidTransform& two_before,
                                           const RigidTransform& before,
                                           const RigidTransform& now,
                                           double step_s);

/// Returns the place and the rotation `after_s` later if both accelerations stay.
[[nodiscard]] RigidTransform continued(const HandMotion& hand, double after_s);

/// Returns the rotation vector that takes one hand to the other, log(to * inverse(from)),
/// in world axes, with its derivatives while both continue [rad]. For the vectors that
/// differ by whole turns the one nearest to `near_rad`. Derivatives to 1e-5 of the
/// angular accelerations.
[[nodiscard]] Motion3 turn_between(const HandMotion& from,
                                   const HandMotion& to,
                                   const glm::dvec3& near_rad);

/// Returns `hand` moved by a displacement and turned by a rotation vector, with all its
/// derivatives: inverse of the differences and of turn_between().
[[nodiscard]] HandMotion displaced(const HandMotion& hand,
                                   const Motion3& displacement_m,
                                   const Motion3& turn_rad);

}  // namespace marey::engine
