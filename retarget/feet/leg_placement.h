// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/feet/foot_place.h"

namespace marey::retarget {

/// Returns the foot's bone. Side 0 is left, 1 is right.
[[nodiscard]] constexpr HumanBone foot_bone(int side) {
  return side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
}
[[nodiscard]] constexpr HumanBone toes_bone(int side) {
  return side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
}

/// Returns the position and rotation of a foot of an expanded posture. Rotations come
/// from the posture where it has them.
[[nodiscard]] FootPlace foot_of(const BodyMap& map,
                                const NormalizedPose& pose,
                                std::span<const RigidTransform> world_from_joint,
                                int side);

/// Returns how far a hip must sink for a leg of this length to reach the ankle: steps 1
/// to 3 of Kulpa 2005, 4.2.4.1. At most half the length; beyond that the leg does not
/// reach. [m]
[[nodiscard]] double sink_m(const glm::dvec3& hip_in_world,
                            const glm::dvec3& ankle_in_world,
                            double length_m);

/// Computes the leg from this hip to this ankle, its half-plane turned along (step 5 of
/// 4.2.4.1). Returns the remaining distance of the ankle. [m]
double aim_leg(const glm::dvec3& hip_in_world,
               const glm::dvec3& ankle_in_world,
               double length_m,
               NormalizedLimb& leg);

/// Pitches a foot that bears on one joint (heel: the ankle; else the ball) until the
/// other is not below its own height.
void keep_other_joint_up(const FootMap& foot, bool on_heel, FootPlace& place);

/// Pitches a foot whose front does not bend at the ball until the sole's front end is on
/// the floor Y = 0; the ankle stays. No effect while that end is above the floor.
void keep_tip_up(const FootMap& foot, FootPlace& place);

/// Bends toes up at the ball so that their tip is not below the floor Y = 0.
void keep_toes_up(const FootMap& foot, FootPlace& place);

/// Lifts a foot over the floor Y = 0, smoothly: never below, and almost no lift when it
/// is more than a few `softness_m` above. The heights of the ankle and the ball above
/// their resting heights count, and the sole's rear end; also its front end if no toe
/// joint bends it up.
void lift_over_floor(const FootMap& foot, double softness_m, FootPlace& place);

}  // namespace marey::retarget
