// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/start_at_origin.h"

#include "library/features/level_frame.h"
#include <glm/gtc/quaternion.hpp>

#include "core/pose.h"

namespace marey::library {

void start_at_origin(Motion& motion, const retarget::BodyMap& map) {
  if (motion.poses.empty()) return;
  const BodyPoints body = find_body_points(motion.skeleton, map);
  const LevelFrame start =
      level_frame(body, world_from_joints(motion.skeleton, motion.poses.front()));
  const glm::dquat turn = glm::angleAxis(-start.heading_rad(), glm::dvec3(0.0, 1.0, 0.0));
  for (Pose& pose : motion.poses) {
    pose.root_in_world = turn * (pose.root_in_world - start.origin);
    pose.parent_from_joint.front() = turn * pose.parent_from_joint.front();
  }
}

}  // namespace marey::library
