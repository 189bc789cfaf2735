// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/skeleton.h"
#include "core/transform.h"

namespace marey {

/// A posture of a skeleton. Bones keep their lengths: only the root moves.
struct Pose {
  glm::dvec3 root_in_world{0.0};  ///< The first joint. [m]
  /// Rotation of each joint's frame in its parent's (the root's: in the world), the rest
  /// rotation included. As many as joints.
  std::vector<glm::dquat> parent_from_joint;
};

/// Returns the rest pose of the skeleton, its root at its rest place.
[[nodiscard]] Pose rest_pose(const Skeleton& skeleton);

/// Computes forward kinematics: every joint's frame in the world. One pass, no
/// allocation.
/// Precondition: the pose and `out` have one entry per joint; the first joint is the only
/// root.
void world_from_joints(const Skeleton& skeleton,
                       const Pose& pose,
                       std::span<RigidTransform> out);

/// Returns the same in a new vector.
[[nodiscard]] std::vector<RigidTransform> world_from_joints(const Skeleton& skeleton,
                                                            const Pose& pose);

/// Returns the pose whose joints have these world rotations and whose root is at
/// `root_in_world`. Inverse of world_from_joints() if the bone lengths agree.
[[nodiscard]] Pose pose_from_world(const Skeleton& skeleton,
                                   const glm::dvec3& root_in_world,
                                   std::span<const glm::dquat> world_from_joint);

}  // namespace marey
