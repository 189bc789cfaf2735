// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/relation_measures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

namespace marey::library {
namespace {

constexpr double kSpeedReach_s = 0.1;
constexpr double kTurnReach_s = 0.25;

struct ArmPoints {
  JointIndex shoulder{};
  std::optional<JointPoint> elbow, hand;
};

// Joints that the measures need beyond those of the features.
struct RelationBody {
  BodyPoints points;
  std::array<std::optional<ArmPoints>, 2> arms;
  std::optional<JointIndex> head;
};

RelationBody relation_body(const Skeleton& skeleton, const retarget::BodyMap& map) {
  using enum HumanBone;
  RelationBody body{find_body_points(skeleton, map), {}, map.joint_of[index(kHead)]};
  constexpr HumanBone kUpper[] = {kLeftUpperArm, kRightUpperArm};
  constexpr HumanBone kLower[] = {kLeftLowerArm, kRightLowerArm};
  constexpr HumanBone kEnd[] = {kLeftHand, kRightHand};
  constexpr BodyPoint kElbows[] = {BodyPoint::kLeftElbow, BodyPoint::kRightElbow};
  constexpr BodyPoint kHands[] = {BodyPoint::kLeftHand, BodyPoint::kRightHand};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto upper = map.joint_of[index(kUpper[side])];
    const auto lower = map.joint_of[index(kLower[side])];
    if (!upper || !lower) continue;
    ArmPoints arm{*upper, body.points.points[index(kElbows[side])], std::nullopt};
    if (map.joint_of[index(kEnd[side])] || skeleton[*lower].tip_in_joint) {
      arm.hand = body.points.points[index(kHands[side])];
    }
    body.arms[side] = arm;
  }
  return body;
}

using Frames = std::span<const RigidTransform>;

glm::dvec3 place_of(const JointPoint& point, Frames world) {
  return world[index(point.joint)] * point.p_in_joint;
}

// Middle of two joints.
glm::dvec3 middle(const std::array<JointIndex, 2>& joints, Frames world) {
  return 0.5 *
         (world[index(joints[0])].translation + world[index(joints[1])].translation);
}

struct TrunkPlane {
  glm::dvec3 origin{0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};  // Forward.
  glm::dvec3 up{0.0, 1.0, 0.0};      // From the hips to the shoulders.
};

std::optional<TrunkPlane> trunk_plane(const BodyPoints& body, Frames world) {
  if (!body.shoulders) return std::nullopt;
  TrunkPlane plane;
  plane.origin = middle(body.hip_joints, world);
  const glm::dvec3 up = middle(*body.shoulders, world) - plane.origin;
  const auto between = [&](const std::array<JointIndex, 2>& pair) {
    return world[index(pair[0])].translation - world[index(pair[1])].translation;
  };
  const glm::dvec3 normal =
      glm::cross(between(body.hip_joints) + between(*body.shoulders), up);
  if (glm::length(up) < 1e-9 || glm::length(normal) < 1e-12) return std::nullopt;
  plane.up = glm::normalize(up);
  plane.normal = glm::normalize(normal);
  return plane;
}

double bend_angle_rad(const glm::dvec3& a,
                      const glm::dvec3& middle,
                      const glm::dvec3& b) {
  const glm::dvec3 u = a - middle;
  const glm::dvec3 v = b - middle;
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

void measure_arm(const ArmPoints& arm,
                 const RelationBody& body,
                 Frames world,
                 const std::optional<TrunkPlane>& trunk,
                 RelationMeasures::Side& out) {
  if (!arm.hand) return;
  const double leg_m = body.points.leg_length_m;
  const glm::dvec3 hand = place_of(*arm.hand, world);
  if (body.head) {
    out.hand_over_head = (hand.y - world[index(*body.head)].translation.y) / leg_m;
  }
  out.hand_over_shoulder = (hand.y - world[index(arm.shoulder)].translation.y) / leg_m;
  out.hand_over_elbow = (hand.y - place_of(*arm.elbow, world).y) / leg_m;
  if (trunk) {
    out.hand_before_trunk = glm::dot(hand - trunk->origin, trunk->normal) / leg_m;
  }
}

RelationMeasures measure_frame(const RelationBody& body,
                               const LevelFrame& frame,
                               const Contacts& contacts,
                               Frames world) {
  const double leg_m = body.points.leg_length_m;
  RelationMeasures out;
  const auto trunk = trunk_plane(body.points, world);
  for (std::size_t side = 0; side < 2; ++side) {
    RelationMeasures::Side& to = out.sides[side];
    if (body.arms[side]) measure_arm(*body.arms[side], body, world, trunk, to);
    const auto at = [&](BodyPoint left, BodyPoint right) {
      return position(body.points, side == 0 ? left : right, world);
    };
    const glm::dvec3 knee = at(BodyPoint::kLeftKnee, BodyPoint::kRightKnee);
    const glm::dvec3 ankle = at(BodyPoint::kLeftAnkle, BodyPoint::kRightAnkle);
    const glm::dvec3 toes = at(BodyPoint::kLeftToes, BodyPoint::kRightToes);
    const glm::dvec3 hip = world[index(body.points.hip_joints[side])].translation;
    to.ankle_forward = frame.from_world(ankle).z / leg_m;
    to.knee_rad = bend_angle_rad(hip, knee, ankle);
    const FootContacts& rest = contacts.feet[side];
    to.foot_height =
        std::min(ankle.y - rest.ankle_height_m, toes.y - rest.ball_height_m) / leg_m;
  }
  if (body.arms[0] && body.arms[1] && body.arms[0]->hand && body.arms[1]->hand) {
    out.hands_apart = glm::distance(place_of(*body.arms[0]->hand, world),
                                    place_of(*body.arms[1]->hand, world)) /
                      leg_m;
  }
  out.hip_height = middle(body.points.hip_joints, world).y / leg_m;
  if (trunk) {
    out.trunk_elevation_rad = std::asin(std::clamp(std::abs(trunk->up.y), 0.0, 1.0));
  }
  return out;
}

int reach_in_frames(double reach_s, double hz) {
  return std::max(1, static_cast<int>(std::lround(reach_s * hz)));
}

// Speed and turn rate from the level frames of all poses.
void measure_path(const std::vector<LevelFrame>& frames,
                  double hz,
                  double leg_m,
                  std::vector<RelationMeasures>& out) {
  const int count = static_cast<int>(frames.size());
  std::vector<double> headings(frames.size(), 0.0);
  for (std::size_t k = 1; k < frames.size(); ++k) {
    headings[k] = headings[k - 1] + heading_change_rad(frames[k - 1], frames[k]);
  }
  const int reach = reach_in_frames(kSpeedReach_s, hz);
  const int turn_reach = reach_in_frames(kTurnReach_s, hz);
  for (int k = 0; k < count; ++k) {
    const auto at = [&](int offset) {
      return static_cast<std::size_t>(std::clamp(k + offset, 0, count - 1));
    };
    RelationMeasures& to = out[static_cast<std::size_t>(k)];
    const std::size_t a = at(-reach);
    const std::size_t b = at(reach);
    if (b > a) {
      to.speed = glm::distance(frames[a].origin, frames[b].origin) * hz /
                 (static_cast<double>(b - a) * leg_m);
    }
    const std::size_t c = at(-turn_reach);
    const std::size_t d = at(turn_reach);
    if (d > c) {
      to.turn_rate = (headings[d] - headings[c]) * hz / static_cast<double>(d - c);
    }
  }
}

}  // namespace

std::vector<RelationMeasures> measure_relations(const Motion& motion,
                                                const retarget::BodyMap& map,
                                                const Contacts& contacts) {
  const RelationBody body = relation_body(motion.skeleton, map);
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::vector<RelationMeasures> out;
  std::vector<LevelFrame> frames;
  out.reserve(motion.poses.size());
  frames.reserve(motion.poses.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    frames.push_back(level_frame(body.points, world));
    out.push_back(measure_frame(body, frames.back(), contacts, world));
  }
  measure_path(frames, motion.rate.hz, body.points.leg_length_m, out);
  return out;
}

}  // namespace marey::library
