// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

using testing::Dice;

constexpr double kPi = std::numbers::pi;
// A dozen operations on numbers near one, each rounded to 1e-16.
constexpr double kTurnRounding = 1e-14;

double angle_between_rad(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

TEST(RigidTransform, MovesAPointAsItsPartsDoOneAfterTheOther) {
  Dice dice(1);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform b_from_a{dice.turn(kPi), dice.direction()};
    const RigidTransform c_from_b{dice.turn(kPi), dice.direction()};
    const glm::dvec3 p_in_a = dice.direction();
    EXPECT_LT(
        glm::distance((c_from_b * b_from_a) * p_in_a, c_from_b * (b_from_a * p_in_a)),
        kTurnRounding);
  }
}

TEST(RigidTransform, IsUndoneByItsInverse) {
  Dice dice(2);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform b_from_a{dice.turn(kPi), dice.direction()};
    const glm::dvec3 p_in_a = dice.direction();
    EXPECT_LT(glm::distance(inverse(b_from_a) * (b_from_a * p_in_a), p_in_a),
              kTurnRounding);
  }
}

TEST(RotationVector, ComesBackFromItsQuaternionAtEveryAngle) {
  Dice dice(3);
  for (const double angle_rad :
       {0.0, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 2.0, 3.0, kPi - 1e-9}) {
    for (int i = 0; i < 10; ++i) {
      const glm::dvec3 vector_rad = angle_rad * dice.direction();
      EXPECT_LT(
          glm::distance(rotation_vector(rotation_from_vector(vector_rad)), vector_rad),
          kTurnRounding)
          << "angle " << angle_rad;
    }
  }
}

TEST(RotationVector, RecoversAHalfTurnUpToItsSign) {
  Dice dice(10);
  for (int i = 0; i < 10; ++i) {
    const glm::dvec3 vector_rad = kPi * dice.direction();
    const glm::dvec3 back = rotation_vector(rotation_from_vector(vector_rad));
    EXPECT_LT(std::min(glm::distance(back, vector_rad), glm::distance(back, -vector_rad)),
              kTurnRounding);
  }
}

TEST(RotationVector, KeepsItsRelativeAccuracyForTinyTurns) {
  // Differences of frames are such turns: an absolute 1e-14 would be all noise.
  for (const double angle_rad : {1e-15, 1e-13, 3e-12, 1e-11, 1e-8}) {
    const glm::dvec3 back = rotation_vector(rotation_from_vector({0.0, angle_rad, 0.0}));
    EXPECT_NEAR(back.y / angle_rad, 1.0, 1e-12) << "angle " << angle_rad;
  }
}

TEST(RotationVector, IsTheSameForAQuaternionAndItsNegative) {
  Dice dice(4);
  for (int i = 0; i < 20; ++i) {
    const glm::dquat q = dice.turn(3.0);
    EXPECT_LT(glm::distance(rotation_vector(q), rotation_vector(-q)), kTurnRounding);
  }
}

TEST(RotationVector, IsNeverLongerThanHalfATurn) {
  const glm::dvec3 three_quarters_rad{0.0, 0.0, 1.5 * kPi};
  const glm::dvec3 back = rotation_vector(rotation_from_vector(three_quarters_rad));
  EXPECT_LT(glm::distance(back, {0.0, 0.0, -0.5 * kPi}), kTurnRounding);
}

TEST(RotationBetween, TakesOneDirectionOntoTheOther) {
  Dice dice(5);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 from = dice.between(0.1, 10.0) * dice.direction();
    const glm::dvec3 to = dice.between(0.1, 10.0) * dice.direction();
    const glm::dvec3 turned = rotation_between(from, to) * from;
    EXPECT_LT(glm::distance(glm::normalize(turned), glm::normalize(to)), 1e-12);
  }
}

TEST(RotationBetween, TurnsNoFurtherThanTheDirectionsAreApart) {
  Dice dice(6);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 from = dice.direction();
    const glm::dvec3 to = dice.direction();
    const double apart_rad =
        std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
    EXPECT_NEAR(
        glm::length(rotation_vector(rotation_between(from, to))), apart_rad, 1e-12);
  }
}

TEST(RotationBetween, TurnsOppositeDirectionsByHalfATurn) {
  Dice dice(7);
  for (const glm::dvec3& from : {glm::dvec3(1, 0, 0),
                                 glm::dvec3(0, 1, 0),
                                 glm::dvec3(0, 0, 1),
                                 dice.direction(),
                                 dice.direction()}) {
    const glm::dquat half_turn = rotation_between(from, -3.0 * from);
    EXPECT_LT(glm::distance(half_turn * from, -from), 1e-12);
    EXPECT_NEAR(glm::length(half_turn), 1.0, kTurnRounding);
  }
}

TEST(RotationBetween, StaysAccurateNextToOppositeDirections) {
  // The half turn takes over within sqrt(2e-14) = 1.4e-7 rad of the opposite: there it
  // may be off by that much, and nowhere by more.
  for (const double short_by_rad : {1e-9, 1e-8, 1e-7, 2e-7, 1e-6, 1e-4}) {
    const glm::dvec3 from(1, 0, 0);
    const glm::dvec3 to(-std::cos(short_by_rad), std::sin(short_by_rad), 0.0);
    EXPECT_LT(glm::distance(rotation_between(from, to) * from, to), 1.5e-7)
        << "short of a half turn by " << short_by_rad;
  }
}

TEST(TwistAbout, LeavesASwingPerpendicularToTheAxis) {
  Dice dice(8);
  for (int i = 0; i < 50; ++i) {
    const glm::dquat rotation = dice.turn(3.0);
    const glm::dvec3 axis = dice.direction();
    const glm::dquat twist = twist_about(rotation, axis);
    const glm::dvec3 swing_rad = rotation_vector(rotation * glm::conjugate(twist));
    const glm::dvec3 twist_rad = rotation_vector(twist);
    EXPECT_NEAR(glm::dot(swing_rad, axis), 0.0, 1e-12);
    EXPECT_LT(glm::length(glm::cross(twist_rad, axis)), 1e-12);
  }
}

TEST(TwistAbout, FindsATwistUnderAnySwing) {
  Dice dice(9);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 axis = dice.direction();
    const glm::dvec3 across = glm::normalize(glm::cross(axis, dice.direction()));
    const glm::dquat twist = rotation_from_vector(dice.between(-3.0, 3.0) * axis);
    const glm::dquat swing = rotation_from_vector(dice.between(-3.0, 3.0) * across);
    EXPECT_LT(angle_between_rad(twist_about(swing * twist, axis), twist), 1e-12);
  }
}

TEST(TwistAbout, IsNothingWhenTheSwingIsAHalfTurn) {
  const glm::dquat half_turn(0.0, 1.0, 0.0, 0.0);
  const glm::dquat twist = twist_about(half_turn, {0, 1, 0});
  EXPECT_EQ(twist.w, 1.0);
  EXPECT_EQ(glm::length(glm::dvec3(twist.x, twist.y, twist.z)), 0.0);
}

}  // namespace
}  // namespace marey
