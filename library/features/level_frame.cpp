// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/features/level_frame.h"

#include <cmath>
#include <initializer_list>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace marey::library {
namespace {

constexpr glm::dvec3 kUp(0.0, 1.0, 0.0);
/// Level share of a direction below which it counts as vertical: sine of 8.6 degrees.
constexpr double kMinLevelShare = 0.15;

std::optional<JointIndex> first_of(const retarget::BodyMap& map,
                                   std::initializer_list<HumanBone> bones) {
  for (const HumanBone bone : bones) {
    if (const auto joint = map.joint_of[index(bone)]) return joint;
  }
  return std::nullopt;
}

JointPoint or_else(std::optional<JointIndex> joint, const JointPoint& other) {
  return joint ? JointPoint{*joint, glm::dvec3(0.0)} : other;
}

JointPoint find_hand(const Skeleton& skeleton,
                     const retarget::BodyMap& map,
                     HumanBone hand,
                     HumanBone forearm,
                     const JointPoint& elbow) {
  if (const auto joint = map.joint_of[index(hand)]) return {*joint, glm::dvec3(0.0)};
  const auto lower = map.joint_of[index(forearm)];
  if (lower && skeleton[*lower].tip_in_joint) {
    return {*lower, *skeleton[*lower].tip_in_joint};
  }
  return elbow;
}

JointPoint find_toes(const retarget::BodyMap& map,
                     int side,
                     HumanBone toes,
                     JointIndex ankle) {
  if (const auto joint = map.joint_of[index(toes)]) return {*joint, glm::dvec3(0.0)};
  const glm::dquat t_pose_from_joint = map.joints[index(ankle)].t_pose_from_joint;
  const retarget::FootMap& foot = map.feet[static_cast<std::size_t>(side)];
  return {ankle, glm::inverse(t_pose_from_joint) * foot.ball_from_ankle_in_t_pose};
}

// Sets `level` to the unit level part of a direction; false: it is vertical, or zero.
bool level_part(const glm::dvec3& direction, double length, glm::dvec3& level) {
  const double size = std::hypot(direction.x, direction.z);
  if (!(size > kMinLevelShare * length) || !(size > 1e-9)) return false;
  level = glm::dvec3(direction.x / size, 0.0, direction.z / size);
  return true;
}

}  // namespace

BodyPoint mirrored(BodyPoint point) {
  const int k = static_cast<int>(point);
  if (k < static_cast<int>(BodyPoint::kLeftElbow)) return point;
  // Left points have odd numbers, the right one follows.
  return static_cast<BodyPoint>(k % 2 == 1 ? k + 1 : k - 1);
}

BodyPoints find_body_points(const Skeleton& skeleton, const retarget::BodyMap& map) {
  using enum HumanBone;
  BodyPoints body;
  body.hips = map.hips();
  body.t_pose_from_hips = map.joints[index(body.hips)].t_pose_from_joint;
  body.hip_joints = {map.leg(0).upper, map.leg(1).upper};
  body.leg_length_m = map.leg_length_m;
  const auto left_arm = map.joint_of[index(kLeftUpperArm)];
  const auto right_arm = map.joint_of[index(kRightUpperArm)];
  if (left_arm && right_arm) body.shoulders = {*left_arm, *right_arm};

  const auto set = [&body](BodyPoint point, const JointPoint& place) {
    body.points[index(point)] = place;
    return place;
  };
  const JointPoint hips = set(BodyPoint::kHips, {body.hips, glm::dvec3(0.0)});
  const JointPoint chest =
      set(BodyPoint::kChest, or_else(first_of(map, {kChest, kUpperChest, kSpine}), hips));
  set(BodyPoint::kHead, or_else(first_of(map, {kHead, kNeck, kUpperChest}), chest));
  const JointPoint left_elbow =
      set(BodyPoint::kLeftElbow,
          or_else(first_of(map, {kLeftLowerArm, kLeftUpperArm, kLeftShoulder}), chest));
  const JointPoint right_elbow = set(
      BodyPoint::kRightElbow,
      or_else(first_of(map, {kRightLowerArm, kRightUpperArm, kRightShoulder}), chest));
  set(BodyPoint::kLeftHand,
      find_hand(skeleton, map, kLeftHand, kLeftLowerArm, left_elbow));
  set(BodyPoint::kRightHand,
      find_hand(skeleton, map, kRightHand, kRightLowerArm, right_elbow));
  set(BodyPoint::kLeftKnee, {map.leg(0).lower, glm::dvec3(0.0)});
  set(BodyPoint::kRightKnee, {map.leg(1).lower, glm::dvec3(0.0)});
  set(BodyPoint::kLeftAnkle, {map.leg(0).end, glm::dvec3(0.0)});
  set(BodyPoint::kRightAnkle, {map.leg(1).end, glm::dvec3(0.0)});
  set(BodyPoint::kLeftToes, find_toes(map, 0, kLeftToes, map.leg(0).end));
  set(BodyPoint::kRightToes, find_toes(map, 1, kRightToes, map.leg(1).end));
  return body;
}

glm::dvec3 position(const BodyPoints& body,
                    BodyPoint point,
                    std::span<const RigidTransform> world_from_joint) {
  const JointPoint& place = body.points[index(point)];
  return world_from_joint[index(place.joint)] * place.p_in_joint;
}

glm::dvec3 LevelFrame::from_world(const glm::dvec3& p_in_world) const {
  return turn_from_world(p_in_world - origin);
}

glm::dvec3 LevelFrame::turn_from_world(const glm::dvec3& v_in_world) const {
  return {glm::dot(v_in_world, across), v_in_world.y, glm::dot(v_in_world, forward)};
}

double LevelFrame::heading_rad() const {
  return std::atan2(forward.x, forward.z);
}

LevelFrame level_frame(const BodyPoints& body,
                       std::span<const RigidTransform> world_from_joint) {
  const auto at = [&](JointIndex joint) -> const RigidTransform& {
    return world_from_joint[index(joint)];
  };
  const glm::dvec3 hips = at(body.hips).translation;
  glm::dvec3 sum =
      at(body.hip_joints[0]).translation - at(body.hip_joints[1]).translation;
  if (body.shoulders) {
    sum += at((*body.shoulders)[0]).translation - at((*body.shoulders)[1]).translation;
  }
  LevelFrame frame;
  frame.origin = {hips.x, 0.0, hips.z};
  if (level_part(sum, glm::length(sum), frame.across)) {
    frame.forward = glm::cross(frame.across, kUp);
    return frame;
  }
  const glm::dquat turn = at(body.hips).rotation * glm::inverse(body.t_pose_from_hips);
  if (level_part(turn * glm::dvec3(0.0, 0.0, 1.0), 1.0, frame.forward) ||
      level_part(turn * kUp, 1.0, frame.forward)) {
    frame.across = glm::cross(kUp, frame.forward);
  }
  return frame;
}

double heading_change_rad(const LevelFrame& from, const LevelFrame& to) {
  constexpr double kMaxTurn_rad = 1.4;
  const double change =
      std::remainder(to.heading_rad() - from.heading_rad(), 2.0 * std::numbers::pi);
  return std::abs(change) > kMaxTurn_rad ? 0.0 : change;
}

}  // namespace marey::library
