// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/clip_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>

namespace marey::app {
namespace {

constexpr double kEyeAside_rad = 0.61;  // 35 degrees: both arms and both legs are seen.

using DrawnJoints = std::array<JointIndex, kHumanBoneCount>;

/// Returns the joint of each bone. A missing bone has that of its nearest ancestor.
DrawnJoints joints_of_bones(const Skeleton& skeleton) {
  DrawnJoints out{};
  for (const HumanBone bone : human_bones()) {
    if (const auto joint = skeleton.find(bone)) {
      out[index(bone)] = *joint;
    } else if (const auto above = parent(bone)) {
      out[index(bone)] = out[index(*above)];
    }
  }
  return out;
}

std::int16_t in_mm(double metres) {
  constexpr double kMax = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::clamp(std::round(1000.0 * metres), -kMax, kMax));
}

/// Returns the direction that a posture in normal form faces: the angle of the hips'
/// forward axis about Y from +Z. If that axis is vertical within 25 degrees, as when
/// lying, their up axis is used. [rad]
double facing_rad(const Skeleton& skeleton, const Pose& pose) {
  constexpr double kMinLevel = 0.42;  // Sine of 25 degrees.
  const auto world_from_joint = world_from_joints(skeleton, pose);
  const auto hips = skeleton.find(HumanBone::kHips).value_or(JointIndex{});
  const glm::dquat& turn = world_from_joint[index(hips)].rotation;
  glm::dvec3 ahead = turn * glm::dvec3(0.0, 0.0, 1.0);
  if (std::hypot(ahead.x, ahead.z) < kMinLevel) ahead = turn * glm::dvec3(0.0, 1.0, 0.0);
  return std::atan2(ahead.x, ahead.z);
}

}  // namespace

ClipDrawing draw_clip(const Motion& motion) {
  const DrawnJoints joints = joints_of_bones(motion.skeleton);
  ClipDrawing out;
  glm::dvec3 right(1.0, 0.0, 0.0);
  for (std::size_t i = 0; i < kDrawnPoses; ++i) {
    const std::size_t frame = (2 * i + 1) * motion.poses.size() / (2 * kDrawnPoses);
    const Pose& pose = motion.poses[frame];
    if (i == 0) {
      // Seen from its front, a body that faces +Z has +X to the right.
      const double eye = facing_rad(motion.skeleton, pose) - kEyeAside_rad;
      right = glm::dvec3(std::cos(eye), 0.0, -std::sin(eye));
    }
    const auto world_from_joint = world_from_joints(motion.skeleton, pose);
    const glm::dvec3 hips =
        world_from_joint[index(joints[index(HumanBone::kHips)])].translation;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const glm::dvec3& p = world_from_joint[index(joints[k])].translation;
      out.poses[i][k] = {in_mm(glm::dot(p - hips, right)), in_mm(p.y)};
    }
  }
  return out;
}

}  // namespace marey::app
