// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/synthetic_walk.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {
namespace {

using B = HumanBone;

constexpr double kCycle_s = 1.1;
constexpr double kStride_m = 1.0;
constexpr double kHeelOff = 0.42;  // Shares of the cycle.
constexpr double kToeOff = 0.60;

double smooth(double x) {
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

struct Foot {
  glm::dvec3 ankle{0.0};
  double pitch_rad = 0.0;  // Toes down is positive: about +X.
  bool heel = false;
  bool ball = false;
};

// `ball_from_ankle` of the flat foot, `ankle` where it stands at phase 0 of cycle 0.
Foot foot_at(double cycles, const glm::dvec3& ankle, const glm::dvec3& ball_from_ankle) {
  const double n = std::floor(cycles);
  const double phase = cycles - n;
  const auto pitched = [&](double pitch) {
    return glm::angleAxis(pitch, glm::dvec3(1, 0, 0)) * ball_from_ankle;
  };
  constexpr double kMinPitch = 0.6;
  const glm::dvec3 print = ankle + glm::dvec3(0, 0, n * kStride_m);
  Foot foot;
  foot.heel = phase < kHeelOff;
  foot.ball = phase < kToeOff;
  if (phase < kHeelOff) {
    foot.ankle = print;
  } else if (phase < kToeOff) {
    foot.pitch_rad = kMinPitch * smooth((phase - kHeelOff) / (kToeOff - kHeelOff));
    foot.ankle = print + ball_from_ankle - pitched(foot.pitch_rad);
  } else {
    const double s = (phase - kToeOff) / (1.0 - kToeOff);
    foot.pitch_rad = kMinPitch * (1.0 - smooth(s));
    foot.ankle =
        print + ball_from_ankle - pitched(foot.pitch_rad) +
        glm::dvec3(
            0, 0.08 * std::pow(std::sin(3.14159265358979 * s), 2), kStride_m * smooth(s));
  }
  return foot;
}

// Height of a foot above its path: it hovers, falls and is arrested.
double fall_height(double cycles, double fall_m_per_s2) {
  constexpr double kFall_s = 0.03;
  const double phase = cycles - std::floor(cycles);
  if (phase < kToeOff) {
    const double left_s = std::max(0.0, kFall_s - phase * kCycle_s);
    return 0.5 * fall_m_per_s2 * left_s * left_s;
  }
  const double raised = smooth(std::min(1.0, 2.0 * (phase - kToeOff) / (1.0 - kToeOff)));
  const double fallen_s = std::max(0.0, kFall_s - (1.0 - phase) * kCycle_s);
  return fall_m_per_s2 * (raised * kFall_s * kFall_s - 0.5 * fallen_s * fallen_s);
}

// Rotations of thigh, shank and foot, in the world, that put the ankle where it belongs.
void place_leg(const Skeleton& body,
               int side,
               const glm::dvec3& hips_in_world,
               const Foot& foot,
               std::vector<glm::dquat>& world_from_joint) {
  const bool left = side == 0;
  const B upper = left ? B::kLeftUpperLeg : B::kRightUpperLeg;
  const B lower = left ? B::kLeftLowerLeg : B::kRightLowerLeg;
  const B end = left ? B::kLeftFoot : B::kRightFoot;
  const B toes = left ? B::kLeftToes : B::kRightToes;
  const auto offset = [&](B bone) {
    return body.joints[index(bone)].parent_from_joint.translation;
  };
  const glm::dvec3 hip = hips_in_world + offset(upper);
  const glm::dvec3 reach = foot.ankle - hip;
  const double l1 = glm::length(offset(lower));
  const double l2 = glm::length(offset(end));
  const double d = std::min(glm::length(reach), l1 + l2);
  const double at_hip = std::acos((l1 * l1 + d * d - l2 * l2) / (2 * l1 * d));
  const double at_ankle = std::acos((l2 * l2 + d * d - l1 * l1) / (2 * l2 * d));
  const glm::dvec3 down(0, -1, 0);
  const glm::dquat swing = rotation_between(down, reach);
  const auto bend = [](double a) { return glm::angleAxis(a, glm::dvec3(1, 0, 0)); };
  world_from_joint[index(upper)] = swing * bend(-at_hip);
  world_from_joint[index(lower)] = swing * bend(at_ankle);
  world_from_joint[index(end)] = bend(foot.pitch_rad);
  world_from_joint[index(toes)] = foot.ball ? bend(0.0) : bend(foot.pitch_rad);
}

}  // namespace

SyntheticWalk synthetic_walk(
    int frames, double hz, double noise_rad, double noise_m, double fall_m_per_s2) {
  SyntheticWalk walk;
  const Proportions p = average_proportions(1.75);
  walk.motion.skeleton = make_humanoid(p);
  walk.motion.rate.hz = hz;
  const auto rest =
      world_from_joints(walk.motion.skeleton, rest_pose(walk.motion.skeleton));
  Dice dice(5);
  for (int t = 0; t < frames; ++t) {
    const double cycles = t / hz / kCycle_s;
    Pose pose;
    std::vector<glm::dquat> world_from_joint(rest.size(), glm::dquat(1, 0, 0, 0));
    const double sway = std::sin(4 * 3.14159265358979 * cycles);
    pose.root_in_world = {
        0.0, p[B::kHips].y - 0.065 + 0.012 * sway, kStride_m * (cycles - 0.22)};
    for (int side = 0; side < 2; ++side) {
      const B end = side == 0 ? B::kLeftFoot : B::kRightFoot;
      const B toes = side == 0 ? B::kLeftToes : B::kRightToes;
      glm::dvec3 start = rest[index(end)].translation;
      start.z = 0.0;
      // The right foot is half a cycle ahead.
      const double own = cycles + 0.5 * side;
      start.z -= 0.5 * side * kStride_m;
      Foot foot = foot_at(own, start, p[toes]);
      foot.ankle.y += fall_height(own, fall_m_per_s2);
      walk.feet[static_cast<std::size_t>(side)].heel.push_back(foot.heel);
      walk.feet[static_cast<std::size_t>(side)].ball.push_back(foot.ball);
      place_leg(walk.motion.skeleton, side, pose.root_in_world, foot, world_from_joint);
    }
    pose = pose_from_world(walk.motion.skeleton, pose.root_in_world, world_from_joint);
    for (glm::dquat& q : pose.parent_from_joint) {
      q = q * rotation_from_vector(
                  {dice.noise(noise_rad), dice.noise(noise_rad), dice.noise(noise_rad)});
    }
    pose.root_in_world +=
        glm::dvec3(dice.noise(noise_m), dice.noise(noise_m), dice.noise(noise_m));
    walk.motion.poses.push_back(std::move(pose));
  }
  return walk;
}

}  // namespace marey::testing
