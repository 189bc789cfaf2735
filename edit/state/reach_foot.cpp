// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/reach_foot.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/transform.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/feet/leg_placement.h"

namespace marey::edit {
namespace {

/// Turns a joint about itself in the world, with everything below it.
void turn_joint(const Skeleton& skeleton,
                const std::vector<RigidTransform>& joints,
                JointIndex joint,
                const glm::dquat& turn,
                Pose& pose) {
  const auto& parent = skeleton[joint].parent;
  const glm::dquat above =
      parent ? joints[index(*parent)].rotation : glm::dquat(1.0, 0.0, 0.0, 0.0);
  pose.parent_from_joint[index(joint)] =
      glm::normalize(glm::conjugate(above) * turn * joints[index(joint)].rotation);
}

/// Returns the axis about which a positive turn of the shank bends the knee.
glm::dvec3 knee_axis(const retarget::BodyMap& map,
                     const retarget::LimbMap& leg,
                     const std::vector<RigidTransform>& joints,
                     const glm::dvec3& bend) {
  constexpr double kStraight = 1e-9;  // Product of both lengths, straight within 1e-8.
  if (glm::length(bend) > kStraight) return glm::normalize(bend);
  return retarget::rotation_from_t_pose(map, joints, leg.upper) * leg.hinge_in_t_pose;
}

/// Bends the knee and turns the thigh.
void reach_ankle(const Skeleton& skeleton,
                 const retarget::BodyMap& map,
                 const retarget::LimbMap& leg,
                 const glm::dvec3& target,
                 std::vector<RigidTransform>& joints,
                 Pose& pose) {
  const glm::dvec3 hip = joints[index(leg.upper)].translation;
  const glm::dvec3 thigh = joints[index(leg.lower)].translation - hip;
  const glm::dvec3 shank =
      joints[index(leg.end)].translation - joints[index(leg.lower)].translation;
  const double l1 = glm::length(thigh);
  const double l2 = glm::length(shank);
  const double distance =
      std::clamp(glm::distance(target, hip), std::abs(l1 - l2), l1 + l2);
  const glm::dvec3 bend = glm::cross(thigh, shank);
  const double now = std::atan2(glm::length(bend), glm::dot(thigh, shank));
  const double cosine = (distance * distance - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
  const double wanted = std::acos(std::clamp(cosine, -1.0, 1.0));
  const glm::dquat knee = glm::angleAxis(wanted - now, knee_axis(map, leg, joints, bend));
  turn_joint(skeleton, joints, leg.lower, knee, pose);
  const glm::dvec3 end = thigh + knee * shank;
  if (glm::length(end) > 0.0 && distance > 0.0) {
    turn_joint(skeleton, joints, leg.upper, rotation_between(end, target - hip), pose);
  }
  world_from_joints(skeleton, pose, joints);
}

}  // namespace

double reach_foot(const Skeleton& skeleton,
                  const retarget::BodyMap& map,
                  int side,
                  const retarget::FootPlace& place,
                  Pose& pose) {
  std::vector<RigidTransform> joints = world_from_joints(skeleton, pose);
  const retarget::LimbMap& leg = map.leg(side);
  reach_ankle(skeleton, map, leg, place.ankle_in_world, joints, pose);
  const auto set_turn = [&](JointIndex joint, const glm::dquat& from_t_pose) {
    const glm::dquat wanted = from_t_pose * map.joints[index(joint)].t_pose_from_joint;
    turn_joint(skeleton,
               joints,
               joint,
               wanted * glm::conjugate(joints[index(joint)].rotation),
               pose);
    joints[index(joint)].rotation = wanted;
  };
  const auto foot = map.joint_of[marey::index(retarget::foot_bone(side))];
  const auto toes = map.joint_of[marey::index(retarget::toes_bone(side))];
  if (foot) set_turn(*foot, place.foot);
  if (toes) {
    world_from_joints(skeleton, pose, joints);
    set_turn(*toes, place.toes);
  }
  return glm::distance(joints[index(leg.end)].translation, place.ankle_in_world);
}

}  // namespace marey::edit
