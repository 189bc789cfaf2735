// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/up_of_motion.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/bones/body_places.h"

namespace marey::retarget {
namespace {

// Shares of the frames. Clips of lying and crawling mostly begin with a standing body.
constexpr double kEnoughOfY = 0.1;
constexpr double kEnoughOfOther = 0.5;
constexpr double kCosine45 = 0.7071;  // Cosine of 45 degrees.

constexpr std::array<glm::dvec3, 6> kAxes{glm::dvec3(0, 1, 0),
                                          glm::dvec3(0, 0, 1),
                                          glm::dvec3(1, 0, 0),
                                          glm::dvec3(0, -1, 0),
                                          glm::dvec3(0, 0, -1),
                                          glm::dvec3(-1, 0, 0)};

}  // namespace

MotionUp up_of_motion(const Motion& motion, const FoundBones& found) {
  MAREY_ASSERT(!motion.poses.empty());
  std::array<int, kAxes.size()> counts{};
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    const BodyPlaces p = body_places(
        found, [&](JointIndex joint) { return world[index(joint)].translation; });
    const glm::dvec3 up = unit_of(p.mid_hip() - p.mid_foot());
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
      counts[axis] += glm::dot(up, kAxes[axis]) > kCosine45 ? 1 : 0;
    }
  }
  const auto share = [&](std::size_t axis) {
    return counts[axis] / static_cast<double>(motion.poses.size());
  };
  const auto best = static_cast<std::size_t>(
      std::max_element(counts.begin(), counts.end()) - counts.begin());
  const bool is_other = share(0) < kEnoughOfY && share(best) >= kEnoughOfOther;
  const std::size_t chosen = is_other ? best : 0;
  return {kAxes[chosen], share(chosen)};
}

}  // namespace marey::retarget
