// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/pose.h"

#include "core/base/assert.h"

namespace marey {

Pose rest_pose(const Skeleton& skeleton) {
  MAREY_ASSERT(!skeleton.joints.empty());
  Pose pose;
  pose.root_in_world = skeleton.joints[0].parent_from_joint.translation;
  for (const Joint& joint : skeleton.joints) {
    pose.parent_from_joint.push_back(joint.parent_from_joint.rotation);
  }
  return pose;
}

void world_from_joints(const Skeleton& skeleton,
                       const Pose& pose,
                       std::span<RigidTransform> out) {
  MAREY_ASSERT(pose.parent_from_joint.size() == skeleton.joints.size());
  MAREY_ASSERT(out.size() == skeleton.joints.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    if (!joint.parent) {
      out[i] = {pose.parent_from_joint[i], pose.root_in_world};
    } else {
      out[i] =
          out[index(*joint.parent)] *
          RigidTransform{pose.parent_from_joint[i], joint.parent_from_joint.translation};
    }
  }
}

std::vector<RigidTransform> world_from_joints(const Skeleton& skeleton,
                                              const Pose& pose) {
  std::vector<RigidTransform> out(skeleton.joints.size());
  world_from_joints(skeleton, pose, out);
  return out;
}

Pose pose_from_world(const Skeleton& skeleton,
                     const glm::dvec3& root_in_world,
                     std::span<const glm::dquat> world_from_joint) {
  MAREY_ASSERT(world_from_joint.size() == skeleton.joints.size());
  Pose pose;
  pose.root_in_world = root_in_world;
  pose.parent_from_joint.reserve(world_from_joint.size());
  for (std::size_t i = 0; i < world_from_joint.size(); ++i) {
    const auto& parent = skeleton.joints[i].parent;
    pose.parent_from_joint.push_back(
        parent ? glm::normalize(glm::conjugate(world_from_joint[index(*parent)]) *
                                world_from_joint[i])
               : world_from_joint[i]);
  }
  return pose;
}

}  // namespace marey
