// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/seam_acceleration.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"

namespace marey::edit {

SeamAcceleration seam_acceleration(const Motion& cycle, const PlanarMove& step) {
  const std::size_t frames = cycle.poses.size();
  MAREY_ASSERT(frames >= 4);
  const std::size_t joints = cycle.skeleton.joints.size();
  std::vector<std::vector<glm::dvec3>> places;
  const auto add = [&](const Pose& pose, const PlanarMove& move) {
    places.emplace_back();
    for (const RigidTransform& joint : world_from_joints(cycle.skeleton, pose)) {
      places.back().push_back(move(joint.translation));
    }
  };
  add(cycle.poses.back(), inverse(step));
  for (const Pose& pose : cycle.poses) add(pose, {});
  add(cycle.poses.front(), step);
  std::vector<double> largest;
  for (std::size_t t = 1; t + 1 < places.size(); ++t) {
    double of_frame = 0.0;
    for (std::size_t j = 0; j < joints; ++j) {
      if (!cycle.skeleton.joints[j].bone) continue;
      const glm::dvec3 bend = places[t - 1][j] - 2.0 * places[t][j] + places[t + 1][j];
      of_frame = std::max(of_frame, glm::length(bend));
    }
    largest.push_back(of_frame * cycle.rate.hz * cycle.rate.hz);
  }
  SeamAcceleration out;
  out.seam = std::max(largest.front(), largest.back());
  std::vector<double> inside(largest.begin() + 1, largest.end() - 1);
  const std::size_t at = (inside.size() - 1) * 95 / 100;
  const auto percentile = inside.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(inside.begin(), percentile, inside.end());
  out.inside = *percentile;
  return out;
}

}  // namespace marey::edit
