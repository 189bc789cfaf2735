// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/motion/joint_rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::reconstruct {
namespace {

using testing::Dice;

constexpr double kHalfTurn_rad = std::numbers::pi;

glm::dquat rotation_about(const glm::dvec3& axis, double angle_rad) {
  return glm::angleAxis(angle_rad, axis);
}

/// Returns the cosine of half the angle between two rotations.
double likeness(const glm::dquat& a, const glm::dquat& b) {
  return std::abs(glm::dot(a, b));
}

TEST(JointRotation, TwoHingesAreFoundExactly) {
  Dice dice(3);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 first = dice.direction();
    const glm::dvec3 second = dice.direction();
    if (std::abs(glm::dot(first, second)) > 0.99) continue;
    const double a = dice.between(-2.0, 2.0);
    const double b = dice.between(-2.0, 2.0);
    const HingeAngles found = nearest_hinges(
        rotation_about(first, a) * rotation_about(second, b), first, second);
    EXPECT_NEAR(found.first_rad, a, 1e-9);
    EXPECT_NEAR(found.second_rad, b, 1e-9);
  }
}

TEST(JointRotation, NoOtherAnglesOfTwoHingesComeNearer) {
  Dice dice(4);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 first = dice.direction();
    const glm::dvec3 second = dice.direction();
    const glm::dquat rotation = dice.turn(kHalfTurn_rad);
    const HingeAngles found = nearest_hinges(rotation, first, second);
    const double reached = likeness(rotation,
                                    rotation_about(first, found.first_rad) *
                                        rotation_about(second, found.second_rad));
    for (int a = 0; a < 60; ++a) {
      for (int b = 0; b < 60; ++b) {
        const glm::dquat other = rotation_about(first, a * kHalfTurn_rad / 30.0) *
                                 rotation_about(second, b * kHalfTurn_rad / 30.0);
        EXPECT_LE(likeness(rotation, other), reached + 1e-12);
      }
    }
  }
}

TEST(JointRotation, OneHingeIsTheTwistAboutIt) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, -1.0));
  EXPECT_NEAR(nearest_hinge(rotation_about(axis, 3.0), axis), 3.0, 1e-12);
  EXPECT_NEAR(nearest_hinge(-rotation_about(axis, -1.0), axis), -1.0, 1e-12);
}

TEST(JointRotation, CardanAnglesMakeTheirRotationAgain) {
  Dice dice(5);
  for (int i = 0; i < 1000; ++i) {
    // Every tenth is locked.
    const double middle = i % 10 == 0
                              ? std::copysign(kHalfTurn_rad / 2, dice.between(-1, 1))
                              : dice.between(-1.5, 1.5);
    const glm::dquat rotation = rotation_about({0, 0, 1}, dice.between(-3, 3)) *
                                rotation_about({1, 0, 0}, middle) *
                                rotation_about({0, 1, 0}, dice.between(-3, 3));
    const Cardan found = cardan_angles(rotation, kZxy);
    EXPECT_EQ(found.locked, i % 10 == 0);
    const glm::dquat again = rotation_about({0, 0, 1}, found.angle_rad[0]) *
                             rotation_about({1, 0, 0}, found.angle_rad[1]) *
                             rotation_about({0, 1, 0}, found.angle_rad[2]);
    EXPECT_NEAR(likeness(rotation, again), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace marey::reconstruct
