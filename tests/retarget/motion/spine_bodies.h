// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {

/// Returns an adult with `count` vertebrae, evenly from hips to neck: joints 1 to count.
inline Skeleton with_count(int count) {
  return testing::with_vertebrae(make_humanoid(average_proportions(1.75)), count);
}

inline bool is_vertebra(const Joint& joint) {
  return joint.name.starts_with("vertebra");
}

/// Turns every vertebra by `turn` of its number and the number of vertebrae.
inline Pose bent(const Skeleton& body,
                 int count,
                 const std::function<glm::dquat(int vertebra, int count)>& turn) {
  Pose pose = rest_pose(body);
  for (int k = 1; k <= count; ++k) {
    pose.parent_from_joint[static_cast<std::size_t>(k)] = turn(k - 1, count);
  }
  return pose;
}

/// Returns a random pose of the whole body, with the spine's joints turned by up to
/// `max_rad` in all.
inline Pose random_upper_body(const Skeleton& body,
                              int count,
                              double max_rad,
                              testing::Dice& dice) {
  Pose pose = testing::random_pose(body, dice);
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    if (is_vertebra(body.joints[i])) {
      pose.parent_from_joint[i] = dice.turn(max_rad / count);
    }
  }
  return pose;
}

inline glm::dvec3 place(const Skeleton& body,
                        const std::vector<RigidTransform>& world,
                        HumanBone bone) {
  return world[index(*body.find(bone))].translation;
}

}  // namespace marey::retarget
