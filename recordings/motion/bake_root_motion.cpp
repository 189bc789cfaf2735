// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/bake_root_motion.h"

#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

std::size_t travelling_joint(const Skeleton& skeleton) {
  std::vector<int> children(skeleton.joints.size(), 0);
  for (const Joint& joint : skeleton.joints) {
    if (joint.parent) ++children[index(*joint.parent)];
  }
  // Parents come first, so before the first branch the only child is the next joint.
  std::size_t joint = 0;
  while (children[joint] == 1) ++joint;
  return joint;
}

}  // namespace

PosedBones bake_root_motion(const Skeleton& skeleton,
                            std::span<const RigidTransform> parent_from_joint) {
  MAREY_ASSERT(parent_from_joint.size() == skeleton.joints.size());
  MAREY_ASSERT(!skeleton.joints.empty());
  PosedBones posed;
  for (const RigidTransform& local : parent_from_joint) {
    posed.pose.parent_from_joint.push_back(local.rotation);
  }
  const std::size_t travelling = travelling_joint(skeleton);
  RigidTransform moved = parent_from_joint[0];
  RigidTransform kept = parent_from_joint[0];
  for (std::size_t i = 1; i < parent_from_joint.size(); ++i) {
    const RigidTransform& local = parent_from_joint[i];
    const glm::dvec3& rest = skeleton.joints[i].parent_from_joint.translation;
    if (i <= travelling) {
      moved = moved * local;
      kept = kept * RigidTransform{local.rotation, rest};
    } else {
      posed.ignored_translation_m =
          std::max(posed.ignored_translation_m, glm::distance(local.translation, rest));
    }
  }
  posed.pose.root_in_world =
      parent_from_joint[0].translation + moved.translation - kept.translation;
  return posed;
}

}  // namespace marey::recordings
