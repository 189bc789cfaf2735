// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/gtc/quaternion.hpp>

#include "core/base/ids.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Returns a joint's world rotation relative to the canonical T-pose: identity in the
/// T-pose facing +Z.
/// Precondition: `world_from_joint` are of the skeleton that `map` was made from, and the
/// joint is driven (JointRole other than kFree).
[[nodiscard]] inline glm::dquat rotation_from_t_pose(
    const BodyMap& map,
    std::span<const RigidTransform> world_from_joint,
    JointIndex joint) {
  return world_from_joint[index(joint)].rotation *
         glm::conjugate(map.joints[index(joint)].t_pose_from_joint);
}

}  // namespace marey::retarget
