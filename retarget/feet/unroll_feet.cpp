// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/unroll_feet.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {

void FootUnroller::step(const BodyMap& source,
                        std::span<const RigidTransform> world_from_joint,
                        NormalizedPose& pose) {
  constexpr double kRolled = 0.3;
  const glm::dvec3 up(0.0, 1.0, 0.0);
  const glm::dquat half_roll(0.0, 0.0, 0.0, 1.0);
  for (std::size_t side = 0; side < 2; ++side) {
    const int s = static_cast<int>(side);
    auto& foot = pose.segments[index(foot_bone(s))];
    auto& toes = pose.segments[index(toes_bone(s))];
    if (!foot) continue;
    const glm::dvec3 shin_up =
        rotation_from_t_pose(source, world_from_joint, source.leg(s).lower) * up;
    const double along = glm::dot(*foot * up, shin_up);
    is_rolled_[side] = is_rolled_[side] ? along < kRolled : along < -kRolled;
    if (!is_rolled_[side]) continue;
    if (!found_.first_frame[side]) found_.first_frame[side] = frame_;
    ++found_.frames[side];
    const bool toes_go_along = toes && glm::dot(*toes * up, *foot * up) > 0.0;
    *foot = *foot * half_roll;
    if (toes_go_along) *toes = *toes * half_roll;
  }
  ++frame_;
}

}  // namespace marey::retarget
