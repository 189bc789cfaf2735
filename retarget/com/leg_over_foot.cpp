// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/leg_over_foot.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

// Longest leg, as a share of the bones, unless the reference's is longer; and the length
// before it over which the limit becomes effective.
constexpr double kStraight = 0.995;
constexpr double kStraightens = 0.004;
// Shortest leg, as a share of the bones, unless the reference's is shorter.
constexpr double kFolded = 0.3;
// A foot that differs by less is at its goal. [m; component of a unit quaternion]
constexpr double kSame = 1e-12;

// Rotation from one to the other by the shorter way, scaled by `share`.
glm::dquat part_way(const glm::dquat& from, const glm::dquat& to, double share) {
  glm::dquat turn = to * glm::conjugate(from);
  if (turn.w < 0.0) turn = -turn;
  if (share >= 1.0) return glm::normalize(turn);
  return rotation_from_vector(share * rotation_vector(glm::normalize(turn)));
}

bool is_same_rotation(const glm::dquat& a, const glm::dquat& b) {
  const double sign = glm::dot(a, b) < 0.0 ? -1.0 : 1.0;
  const glm::dquat d = a - sign * b;
  return glm::dot(d, d) < kSame * kSame;
}

// The smaller of two lengths, with a smooth transition: x where x is small or negative.
double smooth_min(double x_m, double limit_m) {
  if (x_m <= 0.0) return x_m;
  if (limit_m <= 0.0) return 0.0;
  const double ratio = x_m / limit_m;
  const double square = ratio * ratio;
  return x_m / std::sqrt(std::sqrt(1.0 + square * square));
}

}  // namespace

StandingLeg::StandingLeg(const Skeleton& skeleton, const BodyMap& map, int side)
    : skeleton_(skeleton), map_(map), side_(static_cast<std::size_t>(side)) {
  const LimbMap& leg = map.leg(side);
  const auto toes = map.joint_of[index(toes_bone(side))];
  has_toes_ = toes.has_value();
  joints_ = {leg.upper, leg.lower, leg.end, toes.value_or(leg.end)};
}

std::optional<std::size_t> StandingLeg::part_of(JointIndex joint) const {
  std::optional<JointIndex> at = joint;
  while (at) {
    if (has_toes_ && *at == joints_[3]) return 3;
    for (std::size_t part = 3; part-- > 0;) {
      if (*at == joints_[part]) return part;
    }
    at = skeleton_[*at].parent;
  }
  return std::nullopt;
}

void StandingLeg::start_frame(std::span<const RigidTransform> world_from_joint,
                              const std::array<LegPart, 4>& parts,
                              const FootGoal& goal) {
  parts_ = parts;
  const auto at = [&](std::size_t part) -> const RigidTransform& {
    return world_from_joint[index(joints_[part])];
  };
  const LimbMap& leg = map_.leg(static_cast<int>(side_));
  hip_in_world_ = at(0).translation;
  ankle_in_world_ = at(2).translation;
  toes_from_ankle_ = at(3).translation - ankle_in_world_;
  bones_ = leg_bones(
      hip_in_world_,
      at(1).translation,
      ankle_in_world_,
      rotation_from_t_pose(map_, world_from_joint, leg.upper) * leg.hinge_in_t_pose);

  hold_ = std::clamp(goal.hold, 0.0, 1.0);
  root_gives_way_ = std::clamp(goal.root_gives_way, 0.0, 1.0);
  is_at_goal_ = true;
  lever_ = {};
  if (hold_ <= 0.0) return;
  goal_in_world_ = goal.place.ankle_in_world;
  const glm::dquat foot = rotation_from_t_pose(map_, world_from_joint, joints_[2]);
  const glm::dquat toes = has_toes_
                              ? rotation_from_t_pose(map_, world_from_joint, joints_[3])
                              : glm::dquat(1.0, 0.0, 0.0, 0.0);
  is_at_goal_ = glm::distance(goal_in_world_, ankle_in_world_) < kSame &&
                is_same_rotation(goal.place.foot, foot) &&
                (!has_toes_ || is_same_rotation(goal.place.toes, toes));
  foot_turn_ = part_way(foot, goal.place.foot, hold_);
  toes_turn_ = has_toes_ ? part_way(toes, goal.place.toes, hold_) : foot_turn_;
  const FootMap& shape = map_.feet[side_];
  const glm::dvec3 pivot_from_ankle =
      foot_turn_ * (has_toes_ ? toes_from_ankle_ : foot * heel_pivot_in_t_pose(shape));
  lever_ = heel_lever(
      shape, -pivot_from_ankle, hold_ * std::clamp(goal.heel_may_rise, 0.0, 1.0));
  set_reach();
}

void StandingLeg::set_reach() {
  const double own_m = bones_.reach_m;
  const double room_m = kStraight * bones_.length_m - own_m;
  const double width_m = kStraightens * bones_.length_m;
  max_reach_m_ = own_m;
  if (room_m > 0.0) {
    max_reach_m_ += room_m * room_m * room_m / (room_m * room_m + width_m * width_m);
  }
  const double fold_m =
      std::max(kFolded * bones_.length_m,
               1.001 * std::abs(glm::length(bones_.up) - glm::length(bones_.down)));
  min_reach_m_ = std::min(own_m, fold_m);
}

double StandingLeg::moved_mass_kg() const {
  const double mass_kg =
      parts_[0].mass_kg + parts_[1].mass_kg + parts_[2].mass_kg + parts_[3].mass_kg;
  if (hold_ <= 0.0) return mass_kg;
  // Shares of the way from hip to ankle at which the masses are.
  const glm::dvec3 along = (bones_.down - bones_.up) / (bones_.reach_m * bones_.reach_m);
  const double thigh = glm::dot(parts_[0].moment, along);
  const double shank =
      parts_[1].mass_kg * glm::dot(-bones_.up, along) + glm::dot(parts_[1].moment, along);
  return mass_kg - hold_ * (thigh + shank + parts_[2].mass_kg + parts_[3].mass_kg);
}

AnkleOverFoot StandingLeg::ankle_over_foot(const glm::dvec3& moved_m) const {
  AnkleOverFoot out;
  const glm::dvec3 hip = hip_in_world_ + moved_m;
  const glm::dvec3 ankle =
      hold_ >= 1.0 ? goal_in_world_
                   : glm::mix(ankle_in_world_ + moved_m, goal_in_world_, hold_);
  out.ankle_from_hip = ankle - hip;
  double reach_m = glm::length(out.ankle_from_hip);
  if (lever_.max_rad > 0.0 && reach_m > bones_.reach_m) {
    const double wanted_m = bones_.reach_m + smooth_min(reach_m - bones_.reach_m,
                                                        max_reach_m_ - bones_.reach_m);
    out.heel_rise_rad =
        heel_rise_rad(lever_, lever_.ankle_from_pivot - out.ankle_from_hip, wanted_m);
    out.ankle_from_hip += rise_m(out);
    reach_m = glm::length(out.ankle_from_hip);
  }
  if (reach_m > max_reach_m_) out.short_m = reach_m - max_reach_m_;
  if (reach_m < min_reach_m_) out.short_m = reach_m - min_reach_m_;
  return out;
}

glm::dvec3 StandingLeg::rise_m(const AnkleOverFoot& ankle) const {
  if (ankle.heel_rise_rad <= 0.0) return glm::dvec3(0.0);
  const glm::dquat rise = rotation_from_vector(ankle.heel_rise_rad * lever_.axis);
  return rise * lever_.ankle_from_pivot - lever_.ankle_from_pivot;
}

LegOverFoot StandingLeg::bend(const glm::dvec3& moved_m,
                              const AnkleOverFoot& ankle) const {
  LegOverFoot out;
  const glm::dvec3 hip = hip_in_world_ + moved_m;
  glm::dvec3 ankle_from_hip = ankle.ankle_from_hip;
  if (ankle.short_m != 0.0) {
    const double reach_m = glm::length(ankle_from_hip);
    if (reach_m > 0.0) ankle_from_hip *= (reach_m - ankle.short_m) / reach_m;
  }
  out.turns = bend_leg(bones_, ankle_from_hip);
  const glm::dvec3 knee = hip - out.turns.thigh * bones_.up;
  out.ankle_in_world = hip + ankle_from_hip;
  out.foot = foot_turn_;
  if (ankle.heel_rise_rad > 0.0) {
    out.foot = rotation_from_vector(ankle.heel_rise_rad * lever_.axis) * foot_turn_;
  }
  const glm::dvec3 ball = out.ankle_in_world + out.foot * toes_from_ankle_;
  out.moment = parts_[0].mass_kg * hip + out.turns.thigh * parts_[0].moment +
               parts_[1].mass_kg * knee + out.turns.shank * parts_[1].moment +
               parts_[2].mass_kg * out.ankle_in_world + out.foot * parts_[2].moment +
               parts_[3].mass_kg * ball + toes_turn_ * parts_[3].moment;
  return out;
}

void StandingLeg::write(const LegOverFoot& leg,
                        std::span<const RigidTransform> world_from_joint,
                        Pose& pose) const {
  const auto rotation = [&](JointIndex joint) {
    return world_from_joint[index(joint)].rotation;
  };
  // `above` is the turn of the part that the joint's parent belongs to.
  const auto turn = [&](std::size_t part, const glm::dquat& above, const glm::dquat& by) {
    const auto parent = skeleton_[joints_[part]].parent;
    const glm::dquat frame =
        parent ? above * rotation(*parent) : glm::dquat(1.0, 0.0, 0.0, 0.0);
    pose.parent_from_joint[index(joints_[part])] =
        glm::normalize(glm::conjugate(frame) * by * rotation(joints_[part]));
  };
  const LegTurns& turns = leg.turns;
  turn(0, glm::dquat(1.0, 0.0, 0.0, 0.0), turns.thigh);
  turn(1, turns.thigh, turns.shank);
  turn(2, turns.shank, leg.foot);
  if (has_toes_) turn(3, leg.foot, toes_turn_);
}

}  // namespace marey::retarget
