// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/dynamics/momentum/made_flight.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace marey::dynamics {
namespace {

using testing::Dice;
using B = HumanBone;

double usual_mass_kg(B bone) {
  switch (bone) {
    case B::kHead:
      return 5.0;
    case B::kLeftUpperLeg:
    case B::kRightUpperLeg:
      return 9.5;
    case B::kLeftLowerLeg:
    case B::kRightLowerLeg:
      return 3.2;
    case B::kLeftUpperArm:
    case B::kRightUpperArm:
      return 1.9;
    case B::kHips:
    case B::kSpine:
    case B::kChest:
    case B::kUpperChest:
      return 8.0;
    default:
      return 0.9;
  }
}

}  // namespace

std::vector<PointMass> made_masses(const Skeleton& skeleton, Dice& dice) {
  std::vector<PointMass> masses;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const auto& bone = skeleton.joints[j].bone;
    if (!bone) continue;
    PointMass mass;
    mass.joint = JointIndex{static_cast<int>(j)};
    mass.p_in_joint = dice.between(0.0, 0.1) * dice.direction();
    mass.mass_kg = dice.between(0.7, 1.3) * usual_mass_kg(*bone);
    // Spreads of a body along its axes, so that the inertia is one that a body can have.
    const auto spread = [&] { return std::pow(dice.between(0.02, 0.1), 2.0); };
    const glm::dvec3 s(spread(), spread(), spread());
    const glm::dmat3 axes = glm::mat3_cast(dice.turn(3.0));
    glm::dmat3 inertia(0.0);
    inertia[0][0] = s.y + s.z;
    inertia[1][1] = s.x + s.z;
    inertia[2][2] = s.x + s.y;
    mass.inertia_per_kg_m2 = axes * inertia * glm::transpose(axes);
    masses.push_back(mass);
  }
  return masses;
}

MadeFlight made_flight(Dice& dice, const MadeFlightRule& rule) {
  MadeFlight out;
  out.skeleton = testing::random_humanoid(dice);
  out.masses = made_masses(out.skeleton, dice);
  out.rate = FrameRate{rule.rate_hz};
  struct Swing {
    glm::dvec3 axis{0.0};
    double rad = 0.0, hz = 0.0, phase = 0.0;
  };
  std::vector<Swing> swings;
  for (std::size_t j = 0; j < out.skeleton.joints.size(); ++j) {
    swings.push_back({dice.direction(),
                      dice.between(0.0, rule.max_swing_rad),
                      dice.between(0.2, rule.max_swing_hz),
                      dice.between(0.0, 2.0 * std::numbers::pi)});
  }
  swings[0].rad *= 0.3;  // The whole body.
  const glm::dvec3 speed(
      dice.between(-2.0, 2.0), dice.between(1.0, 3.0), dice.between(-2.0, 2.0));
  const glm::dquat heading = glm::angleAxis(dice.between(0.0, 6.0), glm::dvec3(0, 1, 0));
  const double whole_s = static_cast<double>(rule.frames - 1) / rule.rate_hz;
  for (std::size_t k = 0; k < rule.frames; ++k) {
    const double t = static_cast<double>(k) / rule.rate_hz;
    Pose pose = rest_pose(out.skeleton);
    pose.root_in_world += t * speed - glm::dvec3(0.0, 0.5 * 9.81 * t * t, 0.0);
    for (std::size_t j = 0; j < swings.size(); ++j) {
      const Swing& s = swings[j];
      const double angle = s.rad * std::sin(2.0 * std::numbers::pi * s.hz * t + s.phase);
      pose.parent_from_joint[j] =
          pose.parent_from_joint[j] * glm::angleAxis(angle, s.axis);
    }
    const double somersault = 2.0 * std::numbers::pi * rule.turns * t / whole_s;
    pose.parent_from_joint[0] = heading *
                                glm::angleAxis(somersault, glm::dvec3(1, 0, 0)) *
                                pose.parent_from_joint[0];
    out.poses.push_back(pose);
  }
  return out;
}

}  // namespace marey::dynamics
