// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/floor_height.h"

#include <algorithm>
#include <limits>

#include "core/pose.h"

namespace marey::recordings {

double standing_height(const Skeleton& skeleton) {
  const auto world_from_joint = world_from_joints(skeleton, rest_pose(skeleton));
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < world_from_joint.size(); ++i) {
    const auto tip = skeleton.joints[i].tip_in_joint;
    lowest = std::min(lowest, world_from_joint[i].translation.y);
    if (tip) lowest = std::min(lowest, (world_from_joint[i] * *tip).y);
  }
  return world_from_joint[0].translation.y - lowest;
}

}  // namespace marey::recordings
