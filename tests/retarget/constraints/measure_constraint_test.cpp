// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/measure_constraint.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/character/make_character.h"
#include "tests/retarget/mapped.h"

namespace marey::retarget {
namespace {

// An average adult in its T-pose: every position follows from its proportions.
class MeasureConstraint : public ::testing::Test {
 protected:
  [[nodiscard]] double error_m(const Goal& goal, const BodyPoint& point) {
    add("asked", point, goal);
    const Shortfall shortfall = shortfall_of();
    EXPECT_EQ(shortfall.rad, 0.0);
    return shortfall.m;
  }
  [[nodiscard]] double error_rad(const Goal& goal, const BodyPoint& point) {
    add("asked", point, goal);
    const Shortfall shortfall = shortfall_of();
    EXPECT_EQ(shortfall.m, 0.0);
    return shortfall.rad;
  }
  [[nodiscard]] Shortfall shortfall_of() const {
    const ConstraintMeasure measure(body_, set_.constraints.back(), set_);
    return measure.shortfall(world_, glm::dvec3(0.0));
  }
  void add(const std::string& id, const BodyPoint& point, const Goal& goal) {
    Constraint constraint;
    constraint.id = id;
    constraint.point = point;
    constraint.goal = goal;
    set_.constraints.push_back(constraint);
  }
  [[nodiscard]] glm::dvec3 at(HumanBone bone) const {
    return world_[index(*body_.skeleton.find(bone))].translation;
  }

  ConstraintSet set_;
  Skeleton skeleton_ = make_humanoid(average_proportions(1.75));
  Character body_ = *make_character("adult", skeleton_, mapped(skeleton_));
  std::vector<RigidTransform> world_ = world_from_joints(skeleton_, rest_pose(skeleton_));
};

const BodyPoint kPalm{"leftHand", {0.1, 0.0, 0.02}};

TEST_F(MeasureConstraint, DistancesAreOffByHowMuchTheyAreWrong) {
  const glm::dvec3 palm = at(HumanBone::kLeftHand) + kPalm.offset_in_t_pose;
  EXPECT_NEAR(
      error_m(DistanceToPoint{0.0, palm + glm::dvec3(0, 0.3, 0.4)}, kPalm), 0.5, 1e-12);
  EXPECT_NEAR(
      error_m(DistanceToPoint{0.2, palm + glm::dvec3(0, 0.3, 0.4)}, kPalm), 0.3, 1e-12);
  const double span = 2.0 * at(HumanBone::kLeftHand).x;
  EXPECT_NEAR(error_m(DistanceToBody{1.0, {"rightHand", {}}}, {"leftHand", {}}),
              span - 1.0,
              1e-12);
  add("other", {"rightHand", {}}, {});
  EXPECT_NEAR(
      error_m(DistanceToConstraint{0.5, "other"}, {"leftHand", {}}), span - 0.5, 1e-12);
}

TEST_F(MeasureConstraint, SpacesAreOffByTheWayToTheirFaces) {
  const glm::dvec3 hand = at(HumanBone::kLeftHand);
  const BodyPoint point{"leftHand", {}};
  const auto box = [&](double from, double to) {
    return std::pair(hand + glm::dvec3(from, -1, -1), hand + glm::dvec3(to, 1, 1));
  };
  const auto [low, high] = box(0.25, 2.0);
  EXPECT_NEAR(error_m(AllowedSpace{low, high}, point), 0.25, 1e-12);
  EXPECT_NEAR(error_m(ForbiddenSpace{low, high}, point), 0.0, 1e-12);
  const auto [left, right] = box(-0.125, 2.0);
  EXPECT_NEAR(error_m(AllowedSpace{left, right}, point), 0.0, 1e-12);
  EXPECT_NEAR(error_m(ForbiddenSpace{left, right}, point), 0.125, 1e-12);
}

// About any axis, on either side of the quaternions' sphere.
TEST_F(MeasureConstraint, OrientationsAreOffByTheirAngle) {
  for (const double angle_rad : {0.5, 3.0}) {
    for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), glm::dvec3(0.6, 0.0, 0.8)}) {
      const glm::dquat turned = glm::angleAxis(angle_rad, axis);
      for (const glm::dquat& q : {turned, -turned}) {
        EXPECT_NEAR(error_rad(SegmentOrientation{q}, {"head", {}}), angle_rad, 1e-12);
      }
    }
  }
}

// 10 mm at 100 mm from the joint are 0.1 rad.
TEST_F(MeasureConstraint, IsMetWithinItsPrecision) {
  Constraint asked;
  asked.precision_m = 0.01;
  asked.goal = DistanceToPoint{};
  EXPECT_TRUE(is_met(asked, {0.009, 0.0}));
  EXPECT_FALSE(is_met(asked, {0.011, 0.0}));
  asked.goal = SegmentOrientation{};
  EXPECT_TRUE(is_met(asked, {0.0, 0.09}));
  EXPECT_FALSE(is_met(asked, {0.0, 0.11}));
  asked.goal = Support{};
  EXPECT_TRUE(is_met(asked, {0.5 * kSupportPrecision_m, 0.0}));
  EXPECT_FALSE(is_met(asked, {0.005, 0.0})) << "supports are exact";
}

// A head with a rotated rest pose: rotations count from the T-pose, and offsets are along
// the T-pose's axes.
TEST_F(MeasureConstraint, EverythingCountsFromTheTPose) {
  const double angle_rad = 0.5;
  body_.t_pose_from_joint.assign(skeleton_.joints.size(), glm::dquat(1, 0, 0, 0));
  body_.t_pose_from_joint[index(*skeleton_.find(HumanBone::kHead))] =
      glm::angleAxis(angle_rad, glm::dvec3(0, 0, 1));
  const double chord = 2.0 * std::sin(angle_rad / 2.0);
  EXPECT_NEAR(error_rad(SegmentOrientation{}, {"head", {}}), angle_rad, 1e-12);
  const glm::dvec3 crown(0.0, 0.2, 0.0);
  EXPECT_NEAR(
      error_m(DistanceToPoint{0.0, at(HumanBone::kHead) + crown}, {"head", crown}),
      0.2 * chord,
      1e-12);
}

TEST_F(MeasureConstraint, SupportsAreOffByTheirPoint) {
  const glm::dvec3 ankle = at(HumanBone::kLeftFoot);
  EXPECT_NEAR(
      error_m(Support{ankle + glm::dvec3(0.1, 0, 0), {}, false}, {"leftFoot", {}}),
      0.1,
      1e-12);
  EXPECT_NEAR(error_m(Support{}, {"leftFoot", {}}), glm::length(ankle), 1e-12)
      << "the caller knows its place";
}

}  // namespace
}  // namespace marey::retarget
