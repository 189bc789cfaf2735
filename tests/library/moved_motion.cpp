// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/library/moved_motion.h"

#include <cmath>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/human/average_proportions.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::library {

Motion random_motion(std::uint64_t seed, int frames, double hz) {
  testing::Dice dice(seed);
  const Skeleton body = make_humanoid(average_proportions(1.75));
  Motion motion{body, FrameRate{hz}, 0, {}};
  // Postures a second apart, and the shorter way between them.
  std::vector<Pose> keys;
  for (int k = 0; k <= static_cast<int>(frames / hz) + 1; ++k) {
    keys.push_back(testing::random_pose(body, dice));
  }
  for (int n = 0; n < frames; ++n) {
    const double time_s = n / hz;
    const auto k = static_cast<std::size_t>(time_s);
    const double part = time_s - static_cast<double>(k);
    Pose pose = keys[k];
    pose.root_in_world =
        (1.0 - part) * keys[k].root_in_world + part * keys[k + 1].root_in_world;
    for (std::size_t j = 0; j < pose.parent_from_joint.size(); ++j) {
      pose.parent_from_joint[j] = glm::normalize(glm::slerp(
          keys[k].parent_from_joint[j], keys[k + 1].parent_from_joint[j], part));
    }
    motion.poses.push_back(pose);
  }
  return motion;
}

Motion moved(Motion motion, double turn_rad, double x_m, double z_m) {
  const glm::dquat turn = glm::angleAxis(turn_rad, glm::dvec3(0.0, 1.0, 0.0));
  for (Pose& pose : motion.poses) {
    pose.root_in_world = turn * pose.root_in_world + glm::dvec3(x_m, 0.0, z_m);
    pose.parent_from_joint[0] = turn * pose.parent_from_joint[0];
  }
  return motion;
}

Motion scaled(Motion motion, double factor) {
  for (Joint& joint : motion.skeleton.joints) {
    joint.parent_from_joint.translation *= factor;
    if (joint.tip_in_joint) *joint.tip_in_joint *= factor;
  }
  for (Pose& pose : motion.poses) pose.root_in_world *= factor;
  return motion;
}

Motion reflected(Motion motion) {
  motion.skeleton = testing::mirrored_body(motion.skeleton);
  for (Pose& pose : motion.poses) {
    pose.root_in_world.x *= -1.0;
    for (glm::dquat& q : pose.parent_from_joint) q = glm::dquat(q.w, q.x, -q.y, -q.z);
  }
  return motion;
}

std::vector<float> random_rows(std::uint64_t seed, int rows) {
  testing::Dice dice(seed);
  std::vector<float> out(static_cast<std::size_t>(rows) * 64, 0.0F);
  for (std::size_t c = 0; c < 57; ++c) {
    const double phase = dice.between(0.0, 6.0);
    const double rate = dice.between(0.05, 0.6);
    const double size = dice.between(0.0, 0.5);
    for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) {
      const double value = size * std::sin(phase + rate * static_cast<double>(r));
      out[r * 64 + c] = static_cast<float>(value + dice.noise(0.02));
    }
  }
  return out;
}

}  // namespace marey::library
