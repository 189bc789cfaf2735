// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/leg_placement.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "retarget/body/rotation_from_t_pose.h"

namespace marey::retarget {

FootPlace foot_of(const BodyMap& map,
                  const NormalizedPose& pose,
                  std::span<const RigidTransform> world_from_joint,
                  int side) {
  const auto turn = [&](HumanBone bone) {
    const auto joint = map.joint_of[index(bone)];
    if (pose.segments[index(bone)]) return *pose.segments[index(bone)];
    if (!joint) return glm::dquat(1, 0, 0, 0);
    return rotation_from_t_pose(map, world_from_joint, *joint);
  };
  return {world_from_joint[index(map.leg(side).end)].translation,
          turn(foot_bone(side)),
          turn(toes_bone(side))};
}

double sink_m(const glm::dvec3& hip_in_world,
              const glm::dvec3& ankle_in_world,
              double length_m) {
  constexpr double kMaxSinkInLegs = 0.5;
  const double aside = glm::length(
      glm::dvec2(hip_in_world.x - ankle_in_world.x, hip_in_world.z - ankle_in_world.z));
  const double rise = std::sqrt(std::max(length_m * length_m - aside * aside, 0.0));
  return std::clamp(
      hip_in_world.y - (ankle_in_world.y + rise), 0.0, kMaxSinkInLegs * length_m);
}

double aim_leg(const glm::dvec3& hip_in_world,
               const glm::dvec3& ankle_in_world,
               double length_m,
               NormalizedLimb& leg) {
  const glm::dvec3 wanted = ankle_in_world - hip_in_world;
  const double distance = glm::length(wanted);
  if (distance < 1e-9) return 0.0;
  const glm::dvec3 now = leg.world_from_limb * glm::dvec3(0, 0, 1);
  leg.world_from_limb =
      glm::normalize(rotation_between(now, wanted) * leg.world_from_limb);
  leg.extension = std::min(distance / length_m, 1.0);
  return std::max(distance - length_m, 0.0);
}

void keep_other_joint_up(const FootMap& foot, bool on_heel, FootPlace& place) {
  const glm::dvec3 flat = foot.ball_from_ankle_in_t_pose;
  const glm::dvec3 now = place.foot * flat;
  const bool sinks = on_heel ? now.y < flat.y : now.y > flat.y;
  if (!sinks) return;
  const glm::dvec2 ground(now.x, now.z);
  const double reach = glm::length(ground);
  if (reach < 1e-6) return;
  const glm::dvec2 ahead = ground * (glm::length(glm::dvec2(flat.x, flat.z)) / reach);
  place.foot =
      glm::normalize(rotation_between(now, {ahead.x, flat.y, ahead.y}) * place.foot);
}

void keep_tip_up(const FootMap& foot, FootPlace& place) {
  const glm::dvec3 tip =
      place.foot * (foot.ball_from_ankle_in_t_pose + foot.tip_from_ball_in_t_pose);
  if (place.ankle_in_world.y + tip.y >= 0.0) return;
  const glm::dvec2 ground(tip.x, tip.z);
  const double ahead = glm::length(ground);
  const double length_m = glm::length(tip);
  if (ahead < 1e-6) return;
  const double y = std::clamp(-place.ankle_in_world.y, -length_m, length_m);
  const glm::dvec2 level = ground * (std::sqrt(length_m * length_m - y * y) / ahead);
  place.foot = glm::normalize(rotation_between(tip, {level.x, y, level.y}) * place.foot);
}

void keep_toes_up(const FootMap& foot, FootPlace& place) {
  const glm::dvec3 tip = place.toes * foot.tip_from_ball_in_t_pose;
  const double ball_m =
      place.ankle_in_world.y + (place.foot * foot.ball_from_ankle_in_t_pose).y;
  const double under_m = -(ball_m + tip.y);
  const double length_m = glm::length(tip);
  if (under_m <= 0.0 || length_m < 1e-6) return;
  const glm::dvec2 ground(tip.x, tip.z);
  const double ahead = glm::length(ground);
  if (ahead < 1e-6) return;
  const double y = std::clamp(tip.y + under_m, -length_m, length_m);
  const glm::dvec2 level = ground * (std::sqrt(length_m * length_m - y * y) / ahead);
  place.toes = glm::normalize(rotation_between(tip, {level.x, y, level.y}) * place.toes);
}

void lift_over_floor(const FootMap& foot, double softness_m, FootPlace& place) {
  const double ankle_m = place.ankle_in_world.y;
  const double ball_m = ankle_m + (place.foot * foot.ball_from_ankle_in_t_pose).y;
  const double heel_m = ankle_m + (place.foot * foot.heel_from_ankle_in_t_pose).y;
  double clearance_m =
      std::min({ankle_m - foot.ankle_height_m, ball_m - foot.ball_height_m, heel_m});
  if (!foot.has_toes) {
    clearance_m =
        std::min(clearance_m, ball_m + (place.foot * foot.tip_from_ball_in_t_pose).y);
  }
  const double wanted_m =
      0.5 *
      (clearance_m + std::sqrt(clearance_m * clearance_m + softness_m * softness_m));
  place.ankle_in_world.y += wanted_m - clearance_m;
}

}  // namespace marey::retarget
