// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/marey_skeleton.h"

#include <cstddef>

#include "core/humanoid.h"

namespace marey::app {

bool is_marey_skeleton(const Skeleton& skeleton) {
  if (skeleton.joints.size() != kHumanBoneCount) return false;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    if (joint.bone != human_bones()[j]) return false;
    if (joint.parent_from_joint.rotation != glm::dquat(1, 0, 0, 0)) return false;
  }
  return true;
}

}  // namespace marey::app
