// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/pose.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

using testing::Dice;

// Rounding down a chain of ten joints.
constexpr double kRounding = 1e-12;

std::vector<glm::dquat> rotations(const std::vector<RigidTransform>& frames) {
  std::vector<glm::dquat> out;
  for (const RigidTransform& frame : frames) out.push_back(frame.rotation);
  return out;
}

TEST(RestPose, PutsEveryJointAtItsRestPlace) {
  Dice dice(11);
  const Skeleton skeleton =
      testing::with_random_axes(testing::random_humanoid(dice), dice);
  const auto world = world_from_joints(skeleton, rest_pose(skeleton));
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    const RigidTransform expected =
        joint.parent ? world[index(*joint.parent)] * joint.parent_from_joint
                     : joint.parent_from_joint;
    EXPECT_LT(glm::distance(world[i].translation, expected.translation), kRounding);
    EXPECT_NEAR(std::abs(glm::dot(world[i].rotation, expected.rotation)), 1.0, kRounding);
  }
}

TEST(WorldFromJoints, KeepsBonesAtTheirLengths) {
  Dice dice(12);
  for (int i = 0; i < 10; ++i) {
    const Skeleton skeleton = testing::random_humanoid(dice);
    const auto world = world_from_joints(skeleton, testing::random_pose(skeleton, dice));
    for (std::size_t j = 1; j < world.size(); ++j) {
      const Joint& joint = skeleton.joints[j];
      EXPECT_NEAR(
          glm::distance(world[j].translation, world[index(*joint.parent)].translation),
          glm::length(joint.parent_from_joint.translation),
          kRounding);
    }
  }
}

TEST(WorldFromJoints, TurnsAboutTheJointThatTurns) {
  // A quarter turn of the left elbow about Z lifts the forearm from +X to +Y.
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  Pose pose = rest_pose(skeleton);
  pose.parent_from_joint[index(HumanBone::kLeftLowerArm)] =
      rotation_from_vector({0.0, 0.0, glm::radians(90.0)});
  const auto world = world_from_joints(skeleton, pose);
  const double forearm_m =
      skeleton.joints[index(HumanBone::kLeftHand)].parent_from_joint.translation.x;
  const glm::dvec3 elbow = world[index(HumanBone::kLeftLowerArm)].translation;
  EXPECT_LT(glm::distance(world[index(HumanBone::kLeftHand)].translation,
                          elbow + glm::dvec3(0.0, forearm_m, 0.0)),
            kRounding);
}

TEST(PoseFromWorld, UndoesForwardKinematics) {
  Dice dice(13);
  for (int i = 0; i < 10; ++i) {
    const Skeleton skeleton =
        testing::with_random_axes(testing::random_humanoid(dice), dice);
    const Pose pose = testing::random_pose(skeleton, dice);
    const auto world = world_from_joints(skeleton, pose);
    const Pose back = pose_from_world(skeleton, world[0].translation, rotations(world));
    const auto again = world_from_joints(skeleton, back);
    for (std::size_t j = 0; j < world.size(); ++j) {
      EXPECT_LT(glm::distance(again[j].translation, world[j].translation), kRounding);
      EXPECT_NEAR(
          std::abs(glm::dot(back.parent_from_joint[j], pose.parent_from_joint[j])),
          1.0,
          kRounding);
    }
  }
}

TEST(WorldFromJointsDeathTest, RefusesAPoseOfAnotherSkeleton) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  Pose pose = rest_pose(skeleton);
  pose.parent_from_joint.pop_back();
  EXPECT_DEATH((void)world_from_joints(skeleton, pose), "contract broken");
}

}  // namespace
}  // namespace marey
