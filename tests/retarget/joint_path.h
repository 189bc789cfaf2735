// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "core/pose.h"

namespace marey::retarget {

/// Returns the position of a bone's joint in every frame, in the world. [m]
[[nodiscard]] inline std::vector<glm::dvec3> joint_path(const Motion& motion,
                                                        HumanBone bone) {
  const JointIndex joint = *motion.skeleton.find(bone);
  std::vector<glm::dvec3> path;
  for (const Pose& pose : motion.poses) {
    path.push_back(world_from_joints(motion.skeleton, pose)[index(joint)].translation);
  }
  return path;
}

}  // namespace marey::retarget
