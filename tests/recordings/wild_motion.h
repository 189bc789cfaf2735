// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "core/motion.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::recordings {

/// Returns `proportions` with every vector except the hips' shifted by up to 20 mm per
/// coordinate: no bone is along an axis, and the sides differ.
inline Proportions uneven(Proportions proportions) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift_m(-0.02, 0.02);
  for (const HumanBone bone : human_bones()) {
    if (bone == HumanBone::kHips) continue;
    for (int i = 0; i < 3; ++i) proportions[bone][i] += shift_m(random);
  }
  return proportions;
}

inline glm::dquat wild_rotation(std::mt19937& random) {
  std::uniform_real_distribution<double> angle_rad(-1.5, 1.5);
  glm::dvec3 vector_rad(0.0);
  for (int i = 0; i < 3; ++i) vector_rad[i] = angle_rad(random);
  return rotation_from_vector(vector_rad);
}

/// Returns the rest pose, then poses with every joint rotated by up to 150 degrees and
/// the root within 2 m. Deterministic.
inline Motion wild_motion(const Skeleton& skeleton, int frames) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> place_m(-2.0, 2.0);
  Motion motion;
  motion.skeleton = skeleton;
  motion.poses.push_back(rest_pose(skeleton));
  for (int frame = 1; frame < frames; ++frame) {
    Pose pose = motion.poses.front();
    for (int i = 0; i < 3; ++i) pose.root_in_world[i] = place_m(random);
    for (glm::dquat& q : pose.parent_from_joint) q = wild_rotation(random);
    motion.poses.push_back(std::move(pose));
  }
  return motion;
}

/// Returns `skeleton` with random rest rotations of its joints' axes and unchanged
/// positions.
inline Skeleton with_turned_axes(const Skeleton& skeleton) {
  std::mt19937 random(11);
  Skeleton turned = skeleton;
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  std::vector<RigidTransform> world_from_joint;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    world_from_joint.push_back({wild_rotation(random), rest[i].translation});
    Joint& joint = turned.joints[i];
    joint.parent_from_joint =
        joint.parent
            ? inverse(world_from_joint[index(*joint.parent)]) * world_from_joint[i]
            : world_from_joint[i];
    if (joint.tip_in_joint) {
      joint.tip_in_joint =
          glm::conjugate(world_from_joint[i].rotation) * *joint.tip_in_joint;
    }
  }
  return turned;
}

/// Returns the largest distance between joints of the same name, over all frames;
/// infinite if the joints or frames differ. [m]
inline double largest_distance_m(const Motion& a, const Motion& b) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (a.poses.size() != b.poses.size()) return kNever;
  if (a.skeleton.joints.size() != b.skeleton.joints.size()) return kNever;
  double largest = 0.0;
  for (std::size_t frame = 0; frame < a.poses.size(); ++frame) {
    const auto in_a = world_from_joints(a.skeleton, a.poses[frame]);
    const auto in_b = world_from_joints(b.skeleton, b.poses[frame]);
    for (std::size_t i = 0; i < in_a.size(); ++i) {
      const auto other = b.skeleton.find(a.skeleton.joints[i].name);
      if (!other) return kNever;
      largest = std::max(
          largest, glm::distance(in_a[i].translation, in_b[index(*other)].translation));
    }
  }
  return largest;
}

}  // namespace marey::recordings
