// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/lift_skin.h"

#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/motion/live_retarget.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

// A ball of skin about every joint, with its height above the floor as radius, and shoes
// that are longer than feet.
Skin skin_of(const Skeleton& body, const BodyMap& map, double radius_m) {
  testing::Dice dice(5);
  const auto rest = world_from_joints(body, rest_pose(body));
  std::vector<SkinVertex> vertices;
  for (const HumanBone bone : {HumanBone::kLeftToes, HumanBone::kRightToes}) {
    SkinVertex tip;
    tip.p_in_world = rest[index(bone)].translation + glm::dvec3(0.0, 0.0, 4.0 * radius_m);
    tip.p_in_world.y = 0.0;
    tip.joints[0] = static_cast<JointIndex>(index(bone));
    tip.weights[0] = 1.0;
    vertices.push_back(tip);
  }
  for (std::size_t j = 0; j < body.joints.size(); ++j) {
    for (int k = 0; k < 60; ++k) {
      SkinVertex v;
      v.p_in_world = rest[j].translation + radius_m * dice.direction();
      v.p_in_world.y = std::max(v.p_in_world.y, 0.0);
      v.joints[0] = static_cast<JointIndex>(j);
      v.weights[0] = 1.0;
      vertices.push_back(v);
    }
  }
  return Skin(body, map, vertices);
}

// Sinks by `depth_m` in the middle of a second, like a body that lies down.
Motion sinking(const Skeleton& body, double depth_m) {
  Motion motion{body, {30.0}, 0, {}};
  for (int t = 0; t < 60; ++t) {
    Pose pose = rest_pose(body);
    const double share = std::max(0.0, 1.0 - std::abs(t - 30) / 10.0);
    pose.root_in_world.y -= depth_m * share;
    motion.poses.push_back(pose);
  }
  return motion;
}

Contacts no_contacts(const Motion& motion) {
  Contacts contacts;
  contacts.frame_count = static_cast<int>(motion.poses.size());
  return contacts;
}

TEST(LiftSkin, RaisesOnlySkinInTheFloor) {
  const Skeleton body = testing::child();
  const BodyMap map = *map_body(body);
  const Skin skin = skin_of(body, map, 0.05);
  Motion motion = sinking(body, 0.8);
  const Motion before = motion;
  const LiftSkinReport report = lift_skin(skin, map, no_contacts(motion), {}, {}, motion);
  EXPECT_NEAR(report.before.depth_m, max_skin_depth(before, skin).depth_m, 1e-12);
  EXPECT_GT(report.before.depth_m, 0.7);
  EXPECT_LE(max_skin_depth(motion, skin).depth_m, 0.001);
  EXPECT_EQ(max_skin_depth(motion, skin).depth_m, report.after.depth_m);
  // A foot alone rises first; frames well above the floor keep their bytes.
  EXPECT_EQ(motion.poses[2].root_in_world, before.poses[2].root_in_world);
  EXPECT_GT(motion.poses[30].root_in_world.y, before.poses[30].root_in_world.y);
}

// The depth of the source's own joints below its floor is permitted.
TEST(LiftSkin, LeavesAllowedDepths) {
  const Skeleton body = testing::child();
  const BodyMap map = *map_body(body);
  const Skin skin = skin_of(body, map, 0.05);
  Motion motion = sinking(body, 0.8);
  const std::vector<double> allowed_m(motion.poses.size(), 0.2);
  lift_skin(skin, map, no_contacts(motion), allowed_m, {}, motion);
  const double left_m = max_skin_depth(motion, skin).depth_m;
  EXPECT_LE(left_m, 0.201);
  EXPECT_GT(left_m, 0.15);
  EXPECT_LE(max_skin_depth(motion, skin, allowed_m).depth_m, 0.001);
}

// Feet are moved by their legs; they keep their orientation.
TEST(LiftSkin, KeepsTheOrientationOfFeet) {
  const Skeleton body = testing::giant();
  const BodyMap map = *map_body(body);
  Pose pose = rest_pose(body);
  pose.parent_from_joint[index(HumanBone::kLeftUpperLeg)] =
      glm::angleAxis(glm::radians(-40.0), glm::dvec3(1, 0, 0));
  pose.parent_from_joint[index(HumanBone::kLeftLowerLeg)] =
      glm::angleAxis(glm::radians(60.0), glm::dvec3(1, 0, 0));
  const auto before = world_from_joints(body, pose);
  std::vector<RigidTransform> scratch(before.size());
  Pose buffer;
  lift_posture(body, map, {0.03, {0.1, 0.03}, {}}, scratch, buffer, pose);
  const auto after = world_from_joints(body, pose);
  const std::size_t foot = index(HumanBone::kLeftFoot);
  const glm::dvec3 moved = after[foot].translation - before[foot].translation;
  EXPECT_LT(glm::distance(moved, glm::dvec3(0, 0.1, 0)), 1e-9);
  EXPECT_GT(std::abs(glm::dot(after[foot].rotation, before[foot].rotation)), 1.0 - 1e-12);
  const std::size_t head = index(HumanBone::kHead);
  EXPECT_NEAR(after[head].translation.y - before[head].translation.y, 0.03, 1e-12);
}

TEST(LiftSkin, IsPartOfRetargetingWholeAndLive) {
  const Motion walk = testing::synthetic_walk(120, 60.0).motion;
  const Skeleton body = testing::giant();
  const BodyMap map = *map_body(body);
  const Skin skin = skin_of(body, map, 0.09);
  RetargetOptions options;
  const auto bare = retarget_motion(walk, body, options);
  ASSERT_TRUE(bare);
  EXPECT_GT(max_skin_depth(bare->motion, skin).depth_m, 0.01);
  options.skin = &skin;
  const auto out = retarget_motion(walk, body, options);
  ASSERT_TRUE(out);
  EXPECT_LE(max_skin_depth(out->motion, skin).depth_m, 0.001);

  LiveRetargetOptions live_options;
  live_options.skin = skin;
  auto live = LiveRetarget::make(walk.skeleton, body, live_options);
  ASSERT_TRUE(live);
  Motion motion{body, walk.rate, 0, {}};
  motion.poses.resize(walk.poses.size());
  for (Pose& pose : motion.poses) pose = rest_pose(body);
  live->step(walk.poses[0], 1.0 / 60.0, motion.poses[0]);
  const long before = testing::allocations();
  for (std::size_t t = 1; t < walk.poses.size(); ++t) {
    live->step(walk.poses[t], 1.0 / 60.0, motion.poses[t]);
  }
  // The scratch posture of the first lift.
  EXPECT_LE(testing::allocations() - before, 1);
  EXPECT_LE(max_skin_depth(motion, skin).depth_m, 0.002);
}

}  // namespace
}  // namespace marey::retarget
