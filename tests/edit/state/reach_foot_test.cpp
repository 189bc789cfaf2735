// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/reach_foot.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::edit {
namespace {

using testing::Dice;

/// A body with a joint between its hips and each thigh that is not a bone.
Skeleton with_hip_joints(const Skeleton& plain) {
  Skeleton out;
  std::vector<JointIndex> moved;
  const auto add = [&](Joint joint) {
    out.joints.push_back(std::move(joint));
    return JointIndex{static_cast<int>(out.joints.size()) - 1};
  };
  for (Joint joint : plain.joints) {
    if (joint.parent) joint.parent = moved[index(*joint.parent)];
    if (joint.bone == HumanBone::kLeftUpperLeg ||
        joint.bone == HumanBone::kRightUpperLeg) {
      Joint between;
      between.name = joint.name + " root";
      between.parent = joint.parent;
      between.parent_from_joint.translation = 0.3 * joint.parent_from_joint.translation;
      joint.parent_from_joint.translation *= 0.7;
      joint.parent = add(std::move(between));
    }
    moved.push_back(add(std::move(joint)));
  }
  return out;
}

TEST(ReachFoot, ReachesAnyPlaceOfAnyBody) {
  Dice dice(7);
  for (int round = 0; round < 50; ++round) {
    const Skeleton body =
        with_hip_joints(testing::with_random_axes(testing::random_humanoid(dice), dice));
    const auto map = retarget::map_body(body);
    ASSERT_TRUE(map) << map.error().message();
    Pose pose = rest_pose(body);
    for (glm::dquat& q : pose.parent_from_joint) q = q * dice.turn(0.5);
    const int side = round % 2;
    const auto& leg = map->leg(side);
    const glm::dvec3 hip = world_from_joints(body, pose)[index(leg.upper)].translation;
    const double reach_m = dice.between(0.6, 0.99) * leg.length_m();
    retarget::FootPlace place{
        hip + reach_m * glm::normalize(glm::dvec3(0, -1, 0) + 0.7 * dice.direction()),
        dice.turn(1.0),
        dice.turn(1.0)};
    EXPECT_LT(reach_foot(body, *map, side, place, pose), 1e-9 /* m */);
    const auto joints = world_from_joints(body, pose);
    EXPECT_LT(glm::distance(joints[index(leg.end)].translation, place.ankle_in_world),
              1e-9 /* m */);
    const glm::dquat foot = retarget::rotation_from_t_pose(*map, joints, leg.end);
    EXPECT_NEAR(std::abs(glm::dot(foot, place.foot)), 1.0, 1e-12);
  }
}

TEST(ReachFoot, ReportsWhatALegIsTooShortFor) {
  Dice dice(8);
  const Skeleton body = testing::random_humanoid(dice);
  const auto map = retarget::map_body(body);
  ASSERT_TRUE(map);
  Pose pose = rest_pose(body);
  const auto& leg = map->leg(0);
  const glm::dvec3 hip = world_from_joints(body, pose)[index(leg.upper)].translation;
  const retarget::FootPlace place{
      hip + glm::dvec3(0.0, -leg.length_m() - 0.05, 0.0), {1, 0, 0, 0}, {1, 0, 0, 0}};
  EXPECT_NEAR(reach_foot(body, *map, 0, place, pose), 0.05, 1e-6 /* m */);
}

}  // namespace
}  // namespace marey::edit
