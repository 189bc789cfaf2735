// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/peak_acceleration.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"

namespace marey::app {

double peak_acceleration_m_per_s2(const Motion& motion) {
  const std::size_t joints = motion.skeleton.joints.size();
  std::array<std::vector<RigidTransform>, 3> world;
  for (auto& frame : world) frame.resize(joints);
  double peak = 0.0;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    world_from_joints(motion.skeleton, motion.poses[t], world[t % 3]);
    if (t < 2) continue;
    for (std::size_t j = 0; j < joints; ++j) {
      if (!motion.skeleton.joints[j].bone) continue;
      const glm::dvec3 change = world[t % 3][j].translation -
                                2.0 * world[(t - 1) % 3][j].translation +
                                world[(t - 2) % 3][j].translation;
      peak = std::max(peak, glm::length(change));
    }
  }
  return peak * motion.rate.hz * motion.rate.hz;
}

}  // namespace marey::app
