// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/retarget/balance_scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/base/smooth_step.h"
#include "retarget/body/anthropometry.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kHz = 60.0;
constexpr int kFrames = 240;
constexpr double kRad = 3.14159265358979323846 / 180.0;

Skeleton adult() {
  return make_humanoid(average_proportions(1.75));
}

// 0, then 1 while the posture is held, then 0.
double held(int frame) {
  constexpr double kFrom = 30.0;
  return smooth_step((frame - kFrom) / (kPostureFirst - kFrom)) *
         smooth_step((kFrames - kFrom - frame) / (kFrames - kFrom - kPostureLast));
}

glm::dquat about(const glm::dvec3& axis, double deg) {
  return glm::angleAxis(deg * kRad, axis);
}

const glm::dvec3 kX(1, 0, 0);
const glm::dvec3 kZ(0, 0, 1);

struct Puppet {
  Skeleton body = adult();
  Pose pose = rest_pose(body);

  Puppet() {
    turn(B::kLeftUpperArm, about(kZ, -75.0));
    turn(B::kRightUpperArm, about(kZ, 75.0));
  }
  void turn(B bone, const glm::dquat& by) {
    pose.parent_from_joint[index(*body.find(bone))] = by;
  }
};

Motion played(const std::function<Pose(int)>& pose_at) {
  Motion out{adult(), {kHz}, 0, {}};
  for (int t = 0; t < kFrames; ++t) out.poses.push_back(pose_at(t));
  return out;
}

}  // namespace

Motion slow_kick() {
  const double leg_m = leg_length_m(average_proportions(1.75));
  return played([leg_m](int t) {
    Puppet p;
    const double share = held(t);
    // Hip over the foot: the left leg leans as a straight rod.
    const double lean_deg = 6.0 * share;
    const double lean_rad = lean_deg * kRad;
    p.pose.root_in_world +=
        glm::dvec3(leg_m * std::sin(lean_rad), leg_m * (std::cos(lean_rad) - 1.0), 0.0);
    p.turn(B::kLeftUpperLeg, about(kZ, -lean_deg));
    p.turn(B::kLeftFoot, about(kZ, lean_deg));
    p.turn(B::kRightUpperLeg, about(kX, -90.0 * share));
    p.turn(B::kSpine, about(kX, -25.0 * share));
    return p.pose;
  });
}

Motion deep_bend() {
  const double leg_m = leg_length_m(average_proportions(1.75));
  return played([leg_m](int t) {
    Puppet p;
    const double share = held(t);
    const double back_deg = 4.0 * share;
    const double back_rad = back_deg * kRad;
    p.pose.root_in_world +=
        glm::dvec3(0.0, leg_m * (std::cos(back_rad) - 1.0), -leg_m * std::sin(back_rad));
    for (const B leg : {B::kLeftUpperLeg, B::kRightUpperLeg}) {
      p.turn(leg, about(kX, -back_deg));
    }
    for (const B foot : {B::kLeftFoot, B::kRightFoot}) p.turn(foot, about(kX, back_deg));
    p.turn(B::kSpine, about(kX, 80.0 * share));
    return p.pose;
  });
}

Motion small_jump(double high_m) {
  constexpr double kGravity_m_per_s2 = 9.81;
  const double half_s = std::sqrt(2.0 * high_m / kGravity_m_per_s2);
  return played([high_m, half_s](int t) {
    Puppet p;
    const double from_apex_s = (t - kFrames / 2) / kHz;
    const double fallen_m = 0.5 * kGravity_m_per_s2 * from_apex_s * from_apex_s;
    if (std::abs(from_apex_s) < half_s) p.pose.root_in_world.y += high_m - fallen_m;
    return p.pose;
  });
}

Skeleton with_trunk(double factor) {
  Proportions p = average_proportions(1.75);
  for (const B bone : {B::kSpine,
                       B::kChest,
                       B::kUpperChest,
                       B::kNeck,
                       B::kLeftShoulder,
                       B::kRightShoulder}) {
    p[bone].y *= factor;
  }
  return make_humanoid(p);
}

MassSpec with_trunk_mass(double factor) {
  constexpr double kTotal_kg = 70.0;
  MassSpec out;
  const double trunk_kg = kTotal_kg * segment_table(out.table).trunk.mass_share;
  out.segment_kg[index(B::kHips)] = factor * trunk_kg;
  out.total_kg = kTotal_kg + (factor - 1.0) * trunk_kg;
  return out;
}

}  // namespace marey::retarget
