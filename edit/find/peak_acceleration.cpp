// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/peak_acceleration.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "core/transform.h"

namespace marey::edit {

PeakAcceleration peak_acceleration(const Motion& motion, const FrameRange& frames) {
  const auto& joints = motion.skeleton.joints;
  const int first = std::max(frames.first, 1);
  const int last = std::min(frames.last, static_cast<int>(motion.poses.size()) - 2);
  PeakAcceleration peak;
  // Places in three frames, in turn.
  std::array<std::vector<RigidTransform>, 3> world;
  for (auto& places : world) places.resize(joints.size());
  const double per_s2 = motion.rate.hz * motion.rate.hz;
  const auto at = [&](int frame) -> std::vector<RigidTransform>& {
    return world[static_cast<std::size_t>(frame) % world.size()];
  };
  for (int t = first - 1; t <= last + 1 && first <= last; ++t) {
    world_from_joints(motion.skeleton, motion.poses[static_cast<std::size_t>(t)], at(t));
    if (t <= first) continue;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!joints[j].bone) continue;
      const glm::dvec3 change = at(t)[j].translation - 2.0 * at(t - 1)[j].translation +
                                at(t - 2)[j].translation;
      const double size = per_s2 * glm::length(change);
      if (size > peak.m_per_s2) peak = {size, *joints[j].bone, t - 1};
    }
  }
  return peak;
}

PeakAcceleration peak_acceleration(const Motion& motion) {
  return peak_acceleration(motion, {0, static_cast<int>(motion.poses.size()) - 1});
}

}  // namespace marey::edit
