// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/edit/varied_walk.h"

#include <cmath>

#include "core/humanoid.h"
#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

constexpr double kSyntheticPeriod_s = 1.1;
constexpr double kPi = 3.14159265358979323846;

// Way of one metre per cycle that turns evenly, from +Z.
PlanarMove path_at(double cycles, double turn_rad) {
  const double turn = cycles * turn_rad;
  if (std::abs(turn_rad) < 1e-12) return {0.0, {0.0, cycles}};
  return {turn, {(1.0 - std::cos(turn)) / turn_rad, std::sin(turn) / turn_rad}};
}

}  // namespace

VariedWalk varied_walk(const VariedWalkOptions& o) {
  VariedWalk out;
  out.period_s = o.period_s;
  const int frames = static_cast<int>(std::lround(o.duration_s * o.hz)) + 1;
  const double synthetic_hz = o.hz * o.period_s / kSyntheticPeriod_s;
  out.motion = testing::synthetic_walk(frames, synthetic_hz).motion;
  out.motion.rate.hz = o.hz;
  const PlanarMove start{o.heading_rad, {1.5, -2.0}};
  out.travel = start * path_at(1.0, o.turn_rad) * inverse(start);
  testing::Dice dice(o.seed);
  for (int n = 0; n < frames; ++n) {
    Pose& pose = out.motion.poses[static_cast<std::size_t>(n)];
    const double cycles = n / o.hz / o.period_s;
    const double grown = 1.0 + o.growth_per_s * n / o.hz;
    for (const HumanBone arm : {HumanBone::kLeftUpperArm, HumanBone::kRightUpperArm}) {
      const double down = arm == HumanBone::kLeftUpperArm ? -1.3 : 1.3;
      const double swing = 0.4 * grown * std::sin(2.0 * kPi * cycles) *
                           (arm == HumanBone::kLeftUpperArm ? 1.0 : -1.0);
      pose.parent_from_joint[index(arm)] = glm::angleAxis(swing, glm::dvec3(1, 0, 0)) *
                                           glm::angleAxis(down, glm::dvec3(0, 0, 1));
    }
    move_pose(start * path_at(cycles, o.turn_rad) * PlanarMove{0.0, {0.0, -cycles}},
              pose);
    for (glm::dquat& q : pose.parent_from_joint) {
      q = q * rotation_from_vector({dice.noise(o.noise_rad),
                                    dice.noise(o.noise_rad),
                                    dice.noise(o.noise_rad)});
    }
    pose.root_in_world.y += 0.02 * (grown - 1.0);
    pose.root_in_world +=
        glm::dvec3(dice.noise(o.noise_m), dice.noise(o.noise_m), dice.noise(o.noise_m));
  }
  return out;
}

VariedWalkOptions random_walk_options(unsigned seed) {
  testing::Dice dice(seed);
  VariedWalkOptions out;
  out.seed = seed + 1000;
  out.hz = seed % 3 == 0 ? 30.0 : seed % 3 == 1 ? 60.0 : 120.0;
  out.period_s = dice.between(0.8, 1.4);
  out.turn_rad = dice.between(-0.17, 0.17);
  out.heading_rad = dice.between(-3.0, 3.0);
  return out;
}

}  // namespace marey::edit
