// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Necks of one joint and of more.
#include <algorithm>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/normalized_skeleton.h"
#include "tests/retarget/mapped.h"
#include "tests/retarget/named_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using testing::Dice;

Skeleton adult_with_neck() {
  return make_humanoid(average_proportions(1.75));
}

Skeleton with_two_neck_joints() {
  return with_joint_above(adult_with_neck(), "head", "neck1", 0.5);
}

std::size_t at(const Skeleton& body, const std::string& name) {
  return index(*body.find(name));
}

double turn_between(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

TEST(NeckCount, ASecondNeckJointGetsItsOwnTurnBack) {
  Dice dice(81);
  const Skeleton body = testing::with_random_axes(with_two_neck_joints(), dice);
  const BodyMap map = mapped(body);
  for (int k = 0; k < 100; ++k) {
    Pose pose = testing::random_pose(body, dice);
    glm::dquat& second = pose.parent_from_joint[at(body, "neck1")];
    second = second * dice.turn(0.5);
    const auto from = world_from_joints(body, pose);
    const auto to =
        world_from_joints(body, expand(normalize(body, map, pose), body, map));
    for (std::size_t i = 0; i < from.size(); ++i) {
      ASSERT_LT(glm::distance(from[i].translation, to[i].translation), 1e-9);
      ASSERT_LT(turn_between(from[i].rotation, to[i].rotation), 1e-7);
    }
  }
}

TEST(NeckCount, TwoNeckJointsPutTheHeadWhereOneDoes) {
  const Skeleton source = adult_with_neck();
  const Skeleton body = with_two_neck_joints();
  const BodyMap source_map = mapped(source);
  const BodyMap map = mapped(body);
  Dice dice(82);
  for (int k = 0; k < 100; ++k) {
    const Pose pose = testing::random_pose(source, dice);
    const auto from = world_from_joints(source, pose);
    const auto to =
        world_from_joints(body, expand(normalize(source, source_map, pose), body, map));
    const std::size_t head = at(source, "head");
    const std::size_t here = at(body, "head");
    ASSERT_LT(glm::distance(from[head].translation, to[here].translation), 1e-3);
    ASSERT_LT(turn_between(from[head].rotation, to[here].rotation), 1e-7);
  }
}

// Looking over the shoulder: each joint takes its part.
TEST(NeckCount, TwoNeckJointsShareATwist) {
  const Skeleton source = adult_with_neck();
  const Skeleton body = with_two_neck_joints();
  const glm::dvec3 along =
      glm::normalize(source.joints[at(source, "head")].parent_from_joint.translation);
  Pose pose = rest_pose(source);
  pose.parent_from_joint[at(source, "neck")] = glm::angleAxis(0.8, along);
  const Pose out = expand(normalize(source, mapped(source), pose), body, mapped(body));
  EXPECT_NEAR(
      turn_between(glm::dquat(1, 0, 0, 0), out.parent_from_joint[at(body, "neck")]),
      0.4,
      1e-3);
  EXPECT_NEAR(
      turn_between(glm::dquat(1, 0, 0, 0), out.parent_from_joint[at(body, "neck1")]),
      0.4,
      1e-3);
}

// One bone has a fixed length; it points to the source's head.
TEST(NeckCount, OneNeckJointPointsAtTheHeadOfTwo) {
  const Skeleton source = with_two_neck_joints();
  const Skeleton body = adult_with_neck();
  const BodyMap source_map = mapped(source);
  const BodyMap map = mapped(body);
  Dice dice(83);
  for (int k = 0; k < 100; ++k) {
    Pose pose = testing::random_pose(source, dice);
    pose.parent_from_joint[at(source, "neck1")] = dice.turn(0.5);
    const auto from = world_from_joints(source, pose);
    const auto to =
        world_from_joints(body, expand(normalize(source, source_map, pose), body, map));
    const glm::dvec3 wanted =
        from[at(source, "head")].translation - from[at(source, "neck")].translation;
    const glm::dvec3 got =
        to[at(body, "head")].translation - to[at(body, "neck")].translation;
    const double too_long_m = glm::length(got) - glm::length(wanted);
    ASSERT_LT(glm::distance(wanted, got), too_long_m + 2e-4);
  }
}

}  // namespace
}  // namespace marey::retarget
