// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/measure_departure.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "core/transform.h"

namespace marey::retarget {
namespace {

/// Calls `visit(frame, joint, angle)` for every joint of every frame.
template <class Visit>
void for_each_turn(const Motion& source, const Motion& adapted, const Visit& visit) {
  MAREY_ASSERT(source.poses.size() == adapted.poses.size());
  MAREY_ASSERT(source.skeleton.joints.size() == adapted.skeleton.joints.size());
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    const auto was = world_from_joints(source.skeleton, source.poses[t]);
    const auto is = world_from_joints(adapted.skeleton, adapted.poses[t]);
    for (std::size_t j = 0; j < was.size(); ++j) {
      const glm::dquat turn =
          glm::normalize(is[j].rotation * glm::conjugate(was[j].rotation));
      visit(t, j, glm::length(marey::rotation_vector(turn)));
    }
  }
}

}  // namespace

std::vector<SegmentDeparture> measure_departure(const Motion& source,
                                                const Motion& adapted) {
  std::vector<SegmentDeparture> out(source.skeleton.joints.size());
  for (std::size_t j = 0; j < out.size(); ++j) out[j].joint = static_cast<JointIndex>(j);
  for_each_turn(source, adapted, [&](std::size_t t, std::size_t j, double rad) {
    out[j].mean_rad += rad / static_cast<double>(source.poses.size());
    if (rad <= out[j].worst_rad) return;
    out[j].worst_rad = rad;
    out[j].worst_frame = static_cast<int>(t);
  });
  return out;
}

std::vector<FrameDeparture> furthest_departures(const Motion& source,
                                                const Motion& adapted,
                                                std::span<const JointIndex> joints) {
  MAREY_ASSERT(!joints.empty());
  std::vector<char> counts(source.skeleton.joints.size(), 0);
  for (const JointIndex joint : joints) counts[index(joint)] = 1;
  std::vector<FrameDeparture> out(source.poses.size(), {joints.front(), 0.0});
  for_each_turn(source, adapted, [&](std::size_t t, std::size_t j, double rad) {
    if (counts[j] && rad > out[t].rad) out[t] = {static_cast<JointIndex>(j), rad};
  });
  return out;
}

}  // namespace marey::retarget
