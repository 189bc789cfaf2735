// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/live_hands.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/transform.h"
#include "core/base/smooth_step.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/hands/arm_clearance.h"

namespace marey::retarget {
namespace {

using P = VolumePart;

constexpr int kClearPasses = 3;
constexpr std::array<double, 3> kHandPoints{-1.0, 0.0, 1.0};  // Wrist to finger tips.
// Parts that a hand can touch and that do not move with an arm.
constexpr std::array kBody{P::kHead,
                           P::kChest,
                           P::kAbdomen,
                           P::kPelvis,
                           P::kLeftThigh,
                           P::kRightThigh,
                           P::kLeftShank,
                           P::kRightShank};
constexpr double kMinDistance_legs = 0.01;  // Smaller distances have the same weight.
// If neither hand is free, the error is shared.
constexpr double kMinLiveFreedom = 1e-3;

std::size_t side_index(int side) {
  return static_cast<std::size_t>(side);
}

// Weighted mean of the displacements of several points of a hand.
struct WeightedShift {
  glm::dvec3 sum_m{0.0};
  double weights = 0.0;
  double strength = 0.0;  // Strength of the strongest point, 0 to 1.

  void add(const glm::dvec3& way_m, double gap_legs, double active) {
    const double near = std::max(gap_legs, 0.0) + kMinDistance_legs;
    const double weight = active / (near * near);
    sum_m += weight * way_m;
    weights += weight;
    strength = std::max(strength, active);
  }
  [[nodiscard]] glm::dvec3 way_m() const {
    return weights > 0.0 ? strength / weights * sum_m : glm::dvec3(0.0);
  }
};

// Both bodies in one posture, with the current shifts of the avatar's arms.
struct LiveScene {
  const PosedVolume& source;
  const PosedVolume& avatar;
  const LiveHandsOptions& options;
  const NormalizedPose& posture;
  std::array<bool, 2> has{};
  std::array<ArmPlaces, 2> source_arms;
  std::array<ArmPlaces, 2> places;  // Avatar's places before,
  std::array<ArmPlaces, 2> now;     // and after the current shifts.
  std::array<ArmShift, 2> shifts;

  LiveScene(const PosedVolume& from,
            const PosedVolume& to,
            const LiveHandsOptions& all,
            const NormalizedPose& pose)
      : source(from), avatar(to), options(all), posture(pose) {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& from_limb = source.map.limbs[i];
      const auto& to_limb = avatar.map.limbs[i];
      has[i] = from_limb && to_limb && posture.limbs[i];
      if (!has[i]) continue;
      source_arms[i] = arm_places(*from_limb, source.world_from_joint);
      places[i] = arm_places(*to_limb, avatar.world_from_joint);
      now[i] = places[i];
    }
  }

  void shift(int side, const ArmShift& by) {
    ArmShift& all = shifts[side_index(side)];
    all.wrist_m += by.wrist_m;
    all.swivel_rad += by.swivel_rad;
    now[side_index(side)] = shifted_places(*avatar.map.limbs[side_index(side)],
                                           places[side_index(side)],
                                           *posture.limbs[side_index(side)],
                                           all);
  }

  // Returns a part of the avatar with the current shifts; only hands are shifted here.
  [[nodiscard]] RigidTransform world_from(P part) const {
    const Capsule& capsule = *avatar.volume[part];
    RigidTransform joint = avatar.world_from_joint[index(capsule.joint)];
    for (int side = 0; side < 2; ++side) {
      if (part != on_side(P::kLeftHand, side) || !has[side_index(side)]) continue;
      joint.translation += now[side_index(side)].wrist - places[side_index(side)].wrist;
    }
    return joint * capsule.joint_from_capsule;
  }

  // Adds the displacements that keep the hand's position relative to a part.
  void add_shift(int side, P part, WeightedShift& out) const {
    const P hand = on_side(P::kLeftHand, side);
    const auto& source_hand = source.volume[hand];
    const auto& avatar_hand = avatar.volume[hand];
    const auto& from = source.volume[part];
    const auto& to = avatar.volume[part];
    if (!source_hand || !avatar_hand || !from || !to) return;
    const RigidTransform source_from_world =
        inverse(source.world_from_joint[index(from->joint)] * from->joint_from_capsule);
    const RigidTransform world_from_part = world_from(part);
    const RigidTransform& world_from_hand =
        avatar.world_from_joint[index(avatar_hand->joint)];
    const glm::dvec3 moved = now[side_index(side)].wrist - places[side_index(side)].wrist;
    for (const double along : kHandPoints) {
      const glm::dvec3 p =
          source_from_world * (source.world_from_joint[index(source_hand->joint)] *
                               axis_point_in_joint(*source_hand, along));
      const double gap_legs = (side_of(*from, p).distance_m - source_hand->radius_m) /
                              source.map.leg_length_m;
      if (gap_legs >= options.far_legs) continue;
      const double active = 1.0 - smooth_step((gap_legs - options.near_legs) /
                                              (options.far_legs - options.near_legs));
      const glm::dvec3 wanted =
          world_from_part *
          carried_over(*from, p, source_hand->radius_m, *to, avatar_hand->radius_m);
      const glm::dvec3 is =
          world_from_hand * axis_point_in_joint(*avatar_hand, along) + moved;
      out.add(wanted - is, gap_legs, active);
    }
  }

  void leave_body(int side) {
    for (int pass = 0; pass < kClearPasses; ++pass) {
      const ArmPenetration penetration = arm_penetration(
          {source.volume,
           source.world_from_joint,
           source_arms[side_index(side)],
           source.floor_m},
          {avatar.volume, avatar.world_from_joint, now[side_index(side)], avatar.floor_m},
          side,
          kArmSlack_m);
      if (std::max(penetration.max_depth_m, penetration.rise_m) <= kArmSlack_m) return;
      ArmShift by = shift_for(
          penetration, *avatar.map.limbs[side_index(side)], now[side_index(side)]);
      by.wrist_m.y += penetration.rise_m;
      shift(side, by);
    }
  }
};

// Moves hands relative to the body, then to each other, then arms out of the body.
void keep_relations(LiveScene& scene) {
  std::array<double, 2> held{};
  for (int side = 0; side < 2; ++side) {
    if (!scene.has[side_index(side)]) continue;
    WeightedShift body_shift;
    for (const P part : kBody) scene.add_shift(side, part, body_shift);
    held[side_index(side)] = body_shift.strength;
    if (body_shift.strength > 0.0) scene.shift(side, {body_shift.way_m(), 0.0});
  }
  if (!scene.has[0] || !scene.has[1]) return;
  // Displacement of the left hand relative to the right one, and the reverse: half each.
  WeightedShift left;
  WeightedShift right;
  scene.add_shift(0, P::kRightHand, left);
  scene.add_shift(1, P::kLeftHand, right);
  if (left.strength <= 0.0 && right.strength <= 0.0) return;
  const glm::dvec3 apart = 0.5 * (left.way_m() - right.way_m());
  const double left_free = 1.0 - held[0] + kMinLiveFreedom;
  const double right_free = 1.0 - held[1] + kMinLiveFreedom;
  scene.shift(0, {apart * (left_free / (left_free + right_free)), 0.0});
  scene.shift(1, {-apart * (right_free / (left_free + right_free)), 0.0});
}

}  // namespace

void LiveHands::Follower::follow(double wanted, double since_last_s, double settle_s) {
  const double left = std::exp(-since_last_s / settle_s);
  const double off = value - wanted;
  const double rate = (per_s + off / settle_s) * since_last_s;
  value = wanted + (off + rate) * left;
  per_s = (per_s - rate / settle_s) * left;
}

ArmShift LiveHands::Shift::follow(const ArmShift& wanted,
                                  const glm::dquat& world_from_axes,
                                  double since_last_s,
                                  double settle_s) {
  const glm::dvec3 wrist_in_axes = glm::conjugate(world_from_axes) * wanted.wrist_m;
  glm::dvec3 followed_m(0.0);
  for (int i = 0; i < 3; ++i) {
    Follower& axis = wrist_m[side_index(i)];
    if (!is_known) axis.value = wrist_in_axes[i];
    axis.follow(wrist_in_axes[i], since_last_s, settle_s);
    followed_m[i] = axis.value;
  }
  if (!is_known) swivel_rad.value = wanted.swivel_rad;
  swivel_rad.follow(wanted.swivel_rad, since_last_s, settle_s);
  is_known = true;
  return {world_from_axes * followed_m, swivel_rad.value};
}

void LiveHands::move(const PosedVolume& source,
                     const PosedVolume& avatar,
                     const LiveHandsOptions& options,
                     double since_last_s,
                     NormalizedPose& posture) {
  LiveScene scene(source, avatar, options, posture);
  keep_relations(scene);
  const JointIndex hips = avatar.map.hips();
  const glm::dquat world_from_axes =
      rotation_from_t_pose(avatar.map, avatar.world_from_joint, hips);
  for (int side = 0; side < 2; ++side) {
    if (!scene.has[side_index(side)]) continue;
    Arm& arm = arms_[side_index(side)];
    const ArmShift touching = arm.to_touch.follow(
        scene.shifts[side_index(side)], world_from_axes, since_last_s, options.settle_s);
    scene.shifts[side_index(side)] = {};
    scene.shift(side, touching);
    scene.leave_body(side);
    const ArmShift& all = scene.shifts[side_index(side)];
    const ArmShift out = limited_shift(
        {all.wrist_m - touching.wrist_m, all.swivel_rad - touching.swivel_rad},
        avatar.map.limbs[side_index(side)]->length_m());
    const ArmShift leaving =
        arm.to_leave.follow(out, world_from_axes, since_last_s, options.leave_s);
    posture.limbs[side_index(side)] = shifted_limb(
        *avatar.map.limbs[side_index(side)],
        scene.places[side_index(side)],
        *posture.limbs[side_index(side)],
        {touching.wrist_m + leaving.wrist_m, touching.swivel_rad + leaving.swivel_rad});
  }
}

}  // namespace marey::retarget
