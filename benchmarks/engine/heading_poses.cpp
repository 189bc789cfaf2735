// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/heading_poses.h"

#include <cmath>
#include <cstddef>

#include <glm/gtc/quaternion.hpp>

#include "core/transform.h"
#include "retarget/contacts/measure_contacts.h"

namespace marey {
namespace {

glm::dquat yaw_rotation(double heading_rad) {
  return {std::cos(0.5 * heading_rad), 0.0, std::sin(0.5 * heading_rad), 0.0};
}

FloorPlace place_of(const TransitionClip& clip, const Pose& pose) {
  const glm::dquat t_pose_from_hips = clip.map.joints.front().t_pose_from_joint;
  const glm::dquat world_from_t_pose =
      pose.parent_from_joint.front() * glm::conjugate(t_pose_from_hips);
  const glm::dquat yaw = twist_about(world_from_t_pose, {0.0, 1.0, 0.0});
  return {{pose.root_in_world.x, pose.root_in_world.z}, 2.0 * std::atan2(yaw.y, yaw.w)};
}

}  // namespace

glm::dvec2 turned(const glm::dvec2& xz, double heading_rad) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  return {c * xz.x + s * xz.y, c * xz.y - s * xz.x};
}

FloorPlace after_step(const FloorPlace& place, const FloorStep& step) {
  return {place.xz_m + turned(step.move_m, place.heading_rad),
          place.heading_rad + step.turn_rad};
}

HeadingClip make_heading_clip(const TransitionClip& clip) {
  HeadingClip out;
  FloorPlace before;
  for (std::size_t t = 0; t < clip.motion.poses.size(); ++t) {
    const Pose& pose = clip.motion.poses[t];
    const FloorPlace place = place_of(clip, pose);
    Pose posture = pose;
    posture.root_in_world = {0.0, pose.root_in_world.y, 0.0};
    posture.parent_from_joint.front() =
        yaw_rotation(-place.heading_rad) * pose.parent_from_joint.front();
    out.postures.push_back(std::move(posture));
    if (t > 0) {
      constexpr double kTurn_rad = 2.0 * 3.14159265358979323846;
      out.steps.push_back(
          {turned(place.xz_m - before.xz_m, -before.heading_rad),
           std::remainder(place.heading_rad - before.heading_rad, kTurn_rad)});
    }
    before = place;
  }
  return out;
}

Pose placed(const Pose& posture, const FloorPlace& place) {
  Pose out = posture;
  out.root_in_world = {place.xz_m.x, posture.root_in_world.y, place.xz_m.y};
  out.parent_from_joint.front() =
      yaw_rotation(place.heading_rad) * posture.parent_from_joint.front();
  return out;
}

std::array<glm::dvec3, kFootPoints> foot_points(const TransitionClip& clip,
                                                const Pose& posture) {
  std::array<glm::dvec3, kFootPoints> out{};
  const auto heading_from_joint = world_from_joints(clip.motion.skeleton, posture);
  for (std::size_t point = 0; point < kFootPoints; ++point) {
    const auto joint = clip.map.joint_of[index(retarget::kContactBones[point])];
    if (joint) out[point] = heading_from_joint[index(*joint)].translation;
  }
  return out;
}

}  // namespace marey
