// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/ask_reach.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr double kReachedWithin_m = 1e-3;
constexpr double kPalmOfForearm = 0.35;

double longest_m(const ReachLengths& lengths, const ReachShare& share) {
  return share.max_extension * (lengths.upper_arm_m + lengths.forearm_m) + lengths.palm_m;
}

double shortest_m(const ReachLengths& lengths, const ReachShare& share) {
  const double a = lengths.upper_arm_m;
  const double b = lengths.forearm_m;
  const double folded =
      std::sqrt(a * a + b * b - 2.0 * a * b * std::cos(share.min_elbow_rad));
  return std::max(0.0, folded - lengths.palm_m);
}

// The shoulder when the trunk leans towards a place and the hips move there.
glm::dvec3 leaned_shoulder(const ReachLengths& lengths,
                           const ReachShare& share,
                           const glm::dvec3& hips,
                           const glm::dvec3& shoulder,
                           const glm::dvec3& towards) {
  const glm::dvec3 trunk = shoulder - hips;
  const glm::dvec3 way = towards - hips;
  glm::dvec3 leaned = shoulder;
  const glm::dvec3 axis = glm::cross(trunk, way);
  const double sine = glm::length(axis);
  if (sine > 1e-12) {
    const double angle = std::atan2(sine, glm::dot(trunk, way));
    leaned =
        hips +
        rotation_from_vector((std::min(angle, share.lean_rad) / sine) * axis) * trunk;
  }
  const glm::dvec3 rest = towards - leaned;
  const double rest_m = glm::length(rest);
  const double step_m = share.step_legs * lengths.leg_m;
  return rest_m <= step_m ? towards : leaned + (step_m / rest_m) * rest;
}

}  // namespace

ReachLengths reach_lengths(const Skeleton& skeleton,
                           const retarget::BodyMap& map,
                           int side) {
  const auto& arm = map.limbs[static_cast<std::size_t>(side)];
  MAREY_ASSERT(arm.has_value());
  ReachLengths lengths;
  lengths.upper_arm_m = arm->upper_length_m;
  lengths.forearm_m = arm->lower_length_m;
  const auto& tip = skeleton[arm->end].tip_in_joint;
  lengths.palm_m = tip ? 0.5 * glm::length(*tip) : kPalmOfForearm * arm->lower_length_m;
  lengths.leg_m = map.leg_length_m;
  // Along the parents, at rest.
  std::optional<JointIndex> joint = arm->upper;
  glm::dvec3 from_hips(0.0);
  while (joint && *joint != map.hips()) {
    const Joint& j = skeleton[*joint];
    joint = j.parent;
    from_hips = j.parent_from_joint.translation + from_hips;
    if (joint) from_hips = skeleton[*joint].parent_from_joint.rotation * from_hips;
  }
  lengths.trunk_m = glm::length(from_hips);
  return lengths;
}

ReachFeasibility ask_reach(const ReachLengths& lengths,
                           const ReachShare& share,
                           const ReachQuestion& question,
                           const ReachOptions& options) {
  const glm::dvec3 target = question.target.p_in_world;
  const double arm_alone_m = glm::distance(target, question.shoulder_in_world);
  ReachFeasibility answer;
  if (arm_alone_m > longest_m(lengths, share)) {
    const glm::dvec3 shoulder = leaned_shoulder(
        lengths, share, question.hips_in_world, question.shoulder_in_world, target);
    answer.missing_m =
        std::max(0.0, glm::distance(target, shoulder) - longest_m(lengths, share));
  } else {
    const double away_m = 2.0 * lengths.trunk_m * std::sin(0.5 * share.lean_rad) +
                          share.step_legs * lengths.leg_m;
    answer.missing_m = std::max(0.0, shortest_m(lengths, share) - arm_alone_m - away_m);
  }
  const double arrive_s = std::max(question.clip_remaining_s, 1e-3);
  const ArrivalPlan plan = plan_arrival({.start_s = 0.0,
                                         .moved_m = {},
                                         .turned_rad = {},
                                         .clip_at_arrival = question.clip_at_arrival,
                                         .arrive_s = arrive_s,
                                         .latest_s = 2.0 * arrive_s,
                                         .target = question.target,
                                         .target_time_s = 0.0},
                                        options);
  answer.duration_s = plan.arrive_s();
  answer.reachable = answer.missing_m <= kReachedWithin_m;
  return answer;
}

ReachBall reach_ball(const ReachLengths& lengths,
                     const ReachShare& share,
                     const glm::dvec3& hips_in_world,
                     const glm::dvec3& shoulder_in_world,
                     const glm::dvec3& towards_in_world) {
  const double radius_m = longest_m(lengths, share);
  if (glm::distance(shoulder_in_world, towards_in_world) <= radius_m) {
    return {shoulder_in_world, radius_m};
  }
  return {
      leaned_shoulder(lengths, share, hips_in_world, shoulder_in_world, towards_in_world),
      radius_m};
}

}  // namespace marey::engine
