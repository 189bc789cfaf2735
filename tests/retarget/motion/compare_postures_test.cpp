// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/motion/compare_postures.h"

#include <utility>

#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

TEST(ComparePostures, FindsNothingBetweenAMotionAndItself) {
  const Motion walk = testing::synthetic_walk(60, 60.0).motion;
  const BodyMap map = *map_body(walk.skeleton);
  const PostureFigures figures = compare_postures(walk, map, walk, map);
  EXPECT_LT(figures.legs.median_rad, 1e-7);
  EXPECT_LT(figures.trunk.median_rad, 1e-7);
  EXPECT_EQ(figures.exchanged_share, 0.0);
  EXPECT_EQ(figures.max_speed, figures.source_max_speed);
}

TEST(ComparePostures, NamesTheLegThatIsOff) {
  const Motion walk = testing::synthetic_walk(60, 60.0).motion;
  Motion made = walk;
  for (Pose& pose : made.poses) {
    glm::dquat& hip = pose.parent_from_joint[index(HumanBone::kRightUpperLeg)];
    hip = glm::angleAxis(glm::radians(50.0), glm::dvec3(0, 0, 1)) * hip;
  }
  const BodyMap map = *map_body(walk.skeleton);
  const PostureFigures figures = compare_postures(walk, map, made, map);
  EXPECT_TRUE(figures.legs.bone == HumanBone::kRightUpperLeg ||
              figures.legs.bone == HumanBone::kRightLowerLeg);
  EXPECT_GT(glm::degrees(figures.legs.median_rad), 40.0);
  EXPECT_LT(figures.arms.median_rad, 1e-7);
  EXPECT_EQ(segment_name(figures.trunk), "trunk");
}

// A quarter of a second in a motion: the median does not show it.
TEST(ComparePostures, FindsAFootThatIsTurnedForAWhile) {
  const Motion walk = testing::synthetic_walk(120, 60.0).motion;
  Motion made = walk;
  for (std::size_t t = 60; t < 80; ++t) {
    glm::dquat& ankle = made.poses[t].parent_from_joint[index(HumanBone::kRightFoot)];
    ankle = glm::angleAxis(glm::radians(70.0), glm::dvec3(0, 1, 0)) * ankle;
  }
  const BodyMap map = *map_body(walk.skeleton);
  const PostureFigures figures = compare_postures(walk, map, made, map);
  EXPECT_EQ(figures.feet.bone, HumanBone::kRightFoot);
  EXPECT_EQ(segment_name(figures.feet), "rightFoot");
  EXPECT_LT(figures.feet.median_rad, 1e-7);
  EXPECT_GT(glm::degrees(figures.feet.sustained_rad), 50.0);
  EXPECT_GE(figures.feet.sustained_frame, 60);
  EXPECT_LE(figures.feet.sustained_frame, 65);
  // A shorter interval is a movement.
  for (std::size_t t = 70; t < 80; ++t) made.poses[t] = walk.poses[t];
  EXPECT_LT(compare_postures(walk, map, made, map).feet.sustained_rad, 1e-7);
}

// A shoe with a heel slopes differently from a bare foot, and is not a rotated foot.
TEST(ComparePostures, LeavesOutHowHighAnAnkleLies) {
  const Motion walk = testing::synthetic_walk(120, 60.0).motion;
  Motion made = walk;
  for (const HumanBone toes : {HumanBone::kLeftToes, HumanBone::kRightToes}) {
    glm::dvec3& bone = made.skeleton.joints[index(toes)].parent_from_joint.translation;
    bone.y -= 0.4 * bone.z;
  }
  const PostureFigures figures =
      compare_postures(walk, *map_body(walk.skeleton), made, *map_body(made.skeleton));
  EXPECT_LT(glm::degrees(figures.feet.median_rad), 3.0);
}

TEST(ComparePostures, FindsLeftAndRightExchanged) {
  const Motion walk = testing::synthetic_walk(60, 60.0).motion;
  const BodyMap map = *map_body(walk.skeleton);
  BodyMap exchanged = map;
  for (const HumanBone bone : human_bones()) {
    exchanged.joint_of[index(bone)] = map.joint_of[index(mirrored(bone))];
  }
  EXPECT_EQ(compare_postures(walk, map, walk, exchanged).exchanged_share, 1.0);
}

TEST(ComparePostures, FindsAJointFasterThanTheSourcesAndReportsTheFrame) {
  const Motion walk = testing::synthetic_walk(60, 60.0).motion;
  Motion made = walk;
  glm::dquat& elbow = made.poses[31].parent_from_joint[index(HumanBone::kLeftLowerArm)];
  elbow = glm::angleAxis(glm::radians(120.0), glm::dvec3(0, 1, 0)) * elbow;
  const BodyMap map = *map_body(walk.skeleton);
  const PostureFigures figures = compare_postures(walk, map, made, map);
  EXPECT_GT(figures.max_speed, 3.0 * figures.source_max_speed);
  EXPECT_EQ(figures.fastest_bone, HumanBone::kLeftHand);
  EXPECT_TRUE(figures.fastest_frame == 31 || figures.fastest_frame == 32);
}

// A single bad sample of a recording, which a body that follows it cannot show.
TEST(ComparePostures, ReportsTheFrameWhereTheSourceJumps) {
  Motion walk = testing::synthetic_walk(60, 60.0).motion;
  walk.poses[20].root_in_world.x += 5.0;
  const BodyMap map = *map_body(walk.skeleton);
  const PostureFigures figures = compare_postures(walk, map, walk, map);
  EXPECT_GT(figures.source_max_speed, 100.0);
  EXPECT_TRUE(figures.source_fastest_frame == 20 || figures.source_fastest_frame == 21);
}

}  // namespace
}  // namespace marey::retarget
