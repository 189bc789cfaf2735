// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/bend_leg.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/transform.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

// A leg whose hip is the origin, straight down but for the knee.
struct BentLeg {
  glm::dvec3 knee{0.0};
  glm::dvec3 ankle{0.0};
};

BentLeg bent_leg(double thigh_m, double shank_m, double knee_rad) {
  // A positive turn about +X takes -Y towards -Z: the knee bends forward.
  const glm::dvec3 x(1, 0, 0);
  BentLeg out;
  out.knee = glm::dvec3(0, -thigh_m, 0);
  out.ankle = out.knee + glm::angleAxis(knee_rad, x) * glm::dvec3(0, -shank_m, 0);
  return out;
}

TEST(BendLeg, BringsTheAnkleToAnyPlaceWithinReach) {
  testing::Dice dice(1);
  for (int k = 0; k < 2000; ++k) {
    const double thigh_m = dice.between(0.1, 0.7);
    const double shank_m = thigh_m * dice.between(0.7, 1.4);
    const glm::dquat any = dice.turn(3.1);
    const BentLeg leg = bent_leg(thigh_m, shank_m, dice.between(0.0, 2.5));
    const glm::dvec3 hip = dice.direction();
    const LegBones bones = leg_bones(
        hip, hip + any * leg.knee, hip + any * leg.ankle, any * glm::dvec3(1, 0, 0));
    const double reach_m = dice.between(std::abs(thigh_m - shank_m), thigh_m + shank_m);
    const glm::dvec3 wanted = reach_m * dice.direction();
    const LegTurns turns = bend_leg(bones, wanted);
    const glm::dvec3 ankle = turns.shank * bones.down - turns.thigh * bones.up;
    ASSERT_LT(glm::distance(ankle, wanted), 1e-12) << k;
  }
}

TEST(BendLeg, TurnsNothingWhereTheAnkleIsAlready) {
  testing::Dice dice(2);
  for (int k = 0; k < 500; ++k) {
    const BentLeg leg = bent_leg(0.45, 0.42, dice.between(0.01, 2.5));
    const LegBones bones =
        leg_bones(glm::dvec3(0.0), leg.knee, leg.ankle, glm::dvec3(1, 0, 0));
    const LegTurns turns = bend_leg(bones, leg.ankle);
    EXPECT_LT(glm::length(rotation_vector(turns.thigh)), 1e-7);
    EXPECT_LT(glm::length(rotation_vector(turns.shank)), 1e-7);
  }
}

TEST(BendLeg, KeepsTheDirectionAndTheLengthsWhenTheTargetIsTooFar) {
  const BentLeg leg = bent_leg(0.45, 0.42, 0.7);
  const LegBones bones =
      leg_bones(glm::dvec3(0.0), leg.knee, leg.ankle, glm::dvec3(1, 0, 0));
  const glm::dvec3 wanted(0.3, -1.5, 0.4);
  const LegTurns turns = bend_leg(bones, wanted);
  const glm::dvec3 ankle = turns.shank * bones.down - turns.thigh * bones.up;
  EXPECT_NEAR(glm::length(ankle), 0.87, 1e-9);
  EXPECT_LT(glm::distance(glm::normalize(ankle), glm::normalize(wanted)), 1e-9);
}

TEST(BendLeg, BendsForwardWithoutAJumpWhileTheReferenceStretchesBeyondStraight) {
  glm::dvec3 before(0.0);
  double worst_m = 0.0;
  // From 11 degrees of bend to 4 degrees beyond straight.
  for (int k = 0; k <= 150; ++k) {
    const double knee_rad = (11.0 - 0.1 * k) * 3.14159265358979 / 180.0;
    const BentLeg leg = bent_leg(0.45, 0.42, knee_rad);
    const LegBones bones =
        leg_bones(glm::dvec3(0.0), leg.knee, leg.ankle, glm::dvec3(1, 0, 0));
    const LegTurns turns = bend_leg(bones, {0.0, -0.75, 0.0});
    const glm::dvec3 knee = -(turns.thigh * bones.up);
    EXPECT_GT(knee.z, 0.1) << k;
    if (k > 0) worst_m = std::max(worst_m, glm::distance(knee, before));
    before = knee;
  }
  EXPECT_LT(worst_m, 1e-3);
}

TEST(BendLeg, HardlyDependsOnThePlaneOfAnAlmostStraightLeg) {
  // The plane of a straight leg is noise. A sideways error of the knee by 1 mm must not
  // turn the bent leg sideways.
  const LegBones straight = leg_bones(
      glm::dvec3(0.0), {0.0, -0.45, 0.001}, {0.0, -0.87, 0.0}, glm::dvec3(1, 0, 0));
  const LegBones noisy = leg_bones(
      glm::dvec3(0.0), {0.001, -0.45, 0.0}, {0.0, -0.87, 0.0}, glm::dvec3(1, 0, 0));
  const glm::dvec3 wanted(0.0, -0.75, 0.0);
  const glm::dvec3 one = bend_leg(straight, wanted).thigh * straight.up;
  const glm::dvec3 two = bend_leg(noisy, wanted).thigh * noisy.up;
  EXPECT_LT(glm::distance(one, two), 0.01);
}

}  // namespace
}  // namespace marey::retarget
