// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/arm_clearance.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/transform.h"

namespace marey::retarget {
namespace {

using P = VolumePart;

constexpr std::array kObstacles{
    P::kChest, P::kAbdomen, P::kPelvis, P::kLeftThigh, P::kRightThigh};
constexpr double kNothing_m = 1e-9;
// Swinging the elbow of a nearly straight arm has little effect: below this distance from
// the axis the wrist moves instead, with a smooth transition.
constexpr double kSwingingElbow_m = 0.04;

// A ball on a bone, the element of the penetration test of an arm.
enum class Bone { kUpper, kForearm, kHand };
struct Ball {
  Bone bone;
  double at;  // From the bone's root, 0, to its end, 1.
};
constexpr std::array<Ball, 8> kBalls{{{Bone::kUpper, 0.6},
                                      {Bone::kUpper, 0.8},
                                      {Bone::kForearm, 0.0},
                                      {Bone::kForearm, 1.0 / 3.0},
                                      {Bone::kForearm, 2.0 / 3.0},
                                      {Bone::kForearm, 1.0},
                                      {Bone::kHand, 0.5},
                                      {Bone::kHand, 1.0}}};

struct PlacedBall {
  glm::dvec3 p_in_world{0.0};
  double radius_m = 0.0;
};

PlacedBall placed(const Ball& ball,
                  const ArmPlaces& arm,
                  const BodyVolume& volume,
                  int side,
                  std::span<const RigidTransform> joints) {
  const auto radius_m = [&](P part) {
    const auto& capsule = volume[on_side(part, side)];
    return capsule ? capsule->radius_m : 0.0;
  };
  if (ball.bone == Bone::kUpper) {
    return {glm::mix(arm.shoulder, arm.elbow, ball.at), radius_m(P::kLeftUpperArm)};
  }
  if (ball.bone == Bone::kForearm) {
    return {glm::mix(arm.elbow, arm.wrist, ball.at), radius_m(P::kLeftForearm)};
  }
  const auto& hand = volume[on_side(P::kLeftHand, side)];
  if (!hand) return {arm.wrist, 0.0};
  const glm::dvec3 from_wrist = joints[index(hand->joint)].rotation *
                                axis_point_in_joint(*hand, 2.0 * ball.at - 1.0);
  return {arm.wrist + from_wrist, hand->radius_m};
}

// Penetration of a ball, and its direction.
struct Push {
  glm::dvec3 way{0.0};  // World, [m].
  double depth_m = 0.0;
};

// Returns the distance from `p` along the unit `way` to where a ball has the required
// clearance.
double way_out_m(const Capsule& capsule,
                 const glm::dvec3& p,
                 const glm::dvec3& way,
                 double wanted_m) {
  double along_m = 0.0;
  for (int i = 0; i < 12; ++i) {
    const CapsuleSide side = side_of(capsule, p + along_m * way);
    const double missing_m = wanted_m - side.distance_m;
    if (missing_m <= kNothing_m) break;
    along_m += missing_m / std::max(glm::dot(side.outward, way), 0.4);
  }
  return along_m;
}

Push depenetrate(const Capsule& source,
                 const RigidTransform& world_from_source,
                 const PlacedBall& source_ball,
                 const Capsule& avatar,
                 const RigidTransform& world_from_avatar,
                 const PlacedBall& ball,
                 double slack_m) {
  const glm::dvec3 p = inverse(world_from_avatar) * ball.p_in_world;
  const double distance_m = side_of(avatar, p).distance_m - ball.radius_m;
  if (distance_m > 0.0) return {};
  const glm::dvec3 p_in_source = inverse(world_from_source) * source_ball.p_in_world;
  const double allowed_m =
      std::min(side_of(source, p_in_source).distance_m - source_ball.radius_m, 0.0);
  const Push inside{glm::dvec3(0.0), allowed_m - distance_m};
  if (inside.depth_m <= slack_m + kNothing_m) return inside;
  // The side is that of the source: the direction of the source's position mapped to this
  // body.
  const glm::dvec3 place =
      carried_over(source, p_in_source, source_ball.radius_m, avatar, ball.radius_m);
  const glm::dvec3 way = side_of(avatar, place).outward;
  const double out_m = way_out_m(avatar, p, way, allowed_m - slack_m + ball.radius_m);
  return {world_from_avatar.rotation * (way * out_m), inside.depth_m};
}

// Height of the hand above the floor; negative inside. [m]
double above_floor_m(const ArmOfBody& body, int side) {
  const Capsule& hand = *body.volume[on_side(P::kLeftHand, side)];
  const glm::dquat& turn = body.world_from_joint[index(hand.joint)].rotation;
  return lowest_m(body.volume, side, {turn, body.arm.wrist}) - *body.floor_m;
}

}  // namespace

ArmPenetration arm_penetration(const ArmOfBody& source,
                               const ArmOfBody& avatar,
                               int side,
                               double slack_m) {
  ArmPenetration out;
  const auto source_joints = source.world_from_joint;
  const auto joints = avatar.world_from_joint;
  std::array<PlacedBall, kBalls.size()> source_balls;
  std::array<PlacedBall, kBalls.size()> balls;
  for (std::size_t i = 0; i < kBalls.size(); ++i) {
    source_balls[i] = placed(kBalls[i], source.arm, source.volume, side, source_joints);
    balls[i] = placed(kBalls[i], avatar.arm, avatar.volume, side, joints);
  }
  const P hand = on_side(P::kLeftHand, side);
  if (source.floor_m && avatar.floor_m && source.volume[hand] && avatar.volume[hand]) {
    // The position of a known skin on the floor is exact; for an estimated volume only
    // the difference counts.
    const bool is_skin = !avatar.volume.hand_skin_in_joint[side == 0 ? 0 : 1].empty();
    const double allowed_m = is_skin ? 0.0 : std::min(above_floor_m(source, side), 0.0);
    out.rise_m = std::max(allowed_m - above_floor_m(avatar, side), 0.0);
  }
  for (const P part : kObstacles) {
    const auto& from = source.volume[part];
    const auto& to = avatar.volume[part];
    if (!from || !to) continue;
    const RigidTransform world_from_source =
        source_joints[index(from->joint)] * from->joint_from_capsule;
    const RigidTransform world_from_avatar =
        joints[index(to->joint)] * to->joint_from_capsule;
    for (std::size_t i = 0; i < kBalls.size(); ++i) {
      const Ball& ball = kBalls[i];
      const Push push = depenetrate(*from,
                                    world_from_source,
                                    source_balls[i],
                                    *to,
                                    world_from_avatar,
                                    balls[i],
                                    slack_m);
      out.max_depth_m = std::max(out.max_depth_m, push.depth_m);
      if (ball.bone == Bone::kUpper) take_greater(push.way / ball.at, out.elbow);
      if (ball.bone == Bone::kForearm && ball.at < 1.0) take_greater(push.way, out.elbow);
      if (ball.bone != Bone::kUpper && ball.at > 0.0) take_greater(push.way, out.wrist);
    }
  }
  return out;
}

ArmShift shift_for(const ArmPenetration& penetration,
                   const LimbMap& limb,
                   const ArmPlaces& arm) {
  ArmShift out{penetration.wrist, 0.0};
  const glm::dvec3 reach = arm.wrist - arm.shoulder;
  const double reach_m = glm::length(reach);
  if (reach_m < 1e-6) return out;
  const glm::dvec3 axis = reach / reach_m;
  const glm::dvec3 to_elbow = arm.elbow - arm.shoulder;
  const glm::dvec3 radial = to_elbow - axis * glm::dot(to_elbow, axis);
  const glm::dvec3 tangent = glm::cross(axis, radial);  // Per radian. [m]
  const double offset2 = glm::dot(radial, radial);
  out.swivel_rad = std::clamp(glm::dot(penetration.elbow, tangent) /
                                  (offset2 + kSwingingElbow_m * kSwingingElbow_m),
                              -0.5,
                              0.5);
  const glm::dvec3 left = penetration.elbow - out.swivel_rad * tangent;
  const double lever = limb.length_m() / limb.upper_length_m;
  take_greater(left * std::min(lever, reach_m / limb.upper_length_m), out.wrist_m);
  return out;
}

}  // namespace marey::retarget
