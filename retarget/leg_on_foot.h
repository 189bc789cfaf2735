// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/foot_plan.h"
#include "retarget/normalized_skeleton.h"

namespace marey::retarget {

/// The foot's bones. Side 0 is left, 1 is right.
[[nodiscard]] constexpr HumanBone foot_bone(int side) {
  return side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
}
[[nodiscard]] constexpr HumanBone toes_bone(int side) {
  return side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
}

/// Where a foot of an expanded posture is. Turns come from the posture where it has them.
[[nodiscard]] FootPlace foot_of(const BodyMap& map,
                                const NormalizedPose& pose,
                                std::span<const RigidTransform> world_from_joint,
                                int side);

/// How far a hip must sink for a leg of this length to reach the ankle: steps 1 to 3 of
/// Kulpa 2005, 4.2.4.1. At most half the length: past it, the leg gives up. [m]
[[nodiscard]] double sink_m(const glm::dvec3& hip_in_world,
                            const glm::dvec3& ankle_in_world,
                            double length_m);

/// Step 5 of 4.2.4.1: the leg from this hip to this ankle, its half-plane turned along.
/// How far the ankle stays away. [m]
double aim_leg(const glm::dvec3& hip_in_world,
               const glm::dvec3& ankle_in_world,
               double length_m,
               NormalizedLimb& leg);

/// Pitches a foot that bears on one joint (heel: the ankle; else the ball) until the
/// other is not below its own height.
void keep_other_joint_up(const FootMap& foot, bool on_heel, FootPlace& place);

/// Pitches a foot whose front does not bend at the ball until the sole's end in front is
/// on the floor Y = 0; the ankle stays. Nothing happens while that end is above the
/// floor.
void keep_tip_up(const FootMap& foot, FootPlace& place);

/// Bends toes up at the ball as far as their tip would be below the floor Y = 0.
void keep_toes_up(const FootMap& foot, FootPlace& place);

/// Lifts a foot over the floor Y = 0, softly: never below, and hardly at all when it is
/// more than some `softness_m` above. What counts are the ankle and the ball above where
/// they rest, and the sole's end behind; in front, too, where no toe joint bends it up.
void lift_over_floor(const FootMap& foot, double softness_m, FootPlace& place);

}  // namespace marey::retarget
