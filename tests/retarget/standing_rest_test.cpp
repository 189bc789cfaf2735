// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/standing_rest.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/body_map.h"
#include "retarget/normalized_skeleton.h"
#include "tests/support/random_bodies.h"
#include "tests/support/synthetic_walk.h"

namespace marey::retarget {
namespace {

double apart_rad(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(a * glm::conjugate(b)));
}

// The same walk in a file whose zero pose is no human's.
Motion walk_with_odd_rest(std::uint64_t seed) {
  testing::Dice dice(seed);
  Motion walk = testing::synthetic_walk(190, 60.0).motion;
  for (Joint& joint : walk.skeleton.joints) {
    joint.parent_from_joint.rotation = dice.turn(3.0);
  }
  return walk;
}

TEST(StandingRest, KnowsAStandingBodyWhateverItsAxes) {
  testing::Dice dice(1);
  const Skeleton body = testing::random_humanoid(dice);
  EXPECT_TRUE(rests_standing(body));
  EXPECT_TRUE(rests_standing(testing::with_random_axes(body, dice)));
  EXPECT_TRUE(rests_standing(testing::in_a_pose(body, 0.8)));
  EXPECT_FALSE(rests_standing(walk_with_odd_rest(2).skeleton));
}

TEST(StandingRest, ABodyThatFacesAnotherWayDoesNotStandAsOneShould) {
  Skeleton body = testing::giant();
  for (const double turn_rad : {1.6, 3.1, -1.6}) {
    body.joints.front().parent_from_joint.rotation =
        glm::angleAxis(turn_rad, glm::dvec3(0, 1, 0));
    EXPECT_FALSE(rests_standing(body)) << turn_rad;
  }
}

TEST(StandingRest, IsFoundInAWalkAsIfItHadBeenThereAllAlong) {
  const Motion truth = testing::synthetic_walk(190, 60.0).motion;
  const BodyMap true_map = *map_body(truth.skeleton);
  for (const std::uint64_t seed : {2U, 3U, 4U}) {
    Motion walk = walk_with_odd_rest(seed);
    walk.skeleton = standing_rest(walk);
    EXPECT_TRUE(rests_standing(walk.skeleton));
    const auto map = map_body(walk.skeleton);
    ASSERT_TRUE(map);
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_NEAR(map->feet[side].ankle_height_m,
                  true_map.feet[side].ankle_height_m,
                  0.003);
      EXPECT_NEAR(map->feet[side].ball_height_m,
                  true_map.feet[side].ball_height_m,
                  0.003);
    }
    // The walk reads the same but for how its best frames differ from a T-pose.
    const NormalizedPose a = normalize(truth.skeleton, true_map, truth.poses[95]);
    const NormalizedPose b = normalize(walk.skeleton, *map, walk.poses[95]);
    for (std::size_t limb = 0; limb < 4; ++limb) {
      EXPECT_NEAR(a.limbs[limb]->extension, b.limbs[limb]->extension, 1e-9);
      EXPECT_LT(std::abs(a.limbs[limb]->lower_twist_rad - b.limbs[limb]->lower_twist_rad),
                0.25);
    }
    for (const HumanBone bone :
         {HumanBone::kHips, HumanBone::kHead, HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
      EXPECT_LT(apart_rad(*a.segments[index(bone)], *b.segments[index(bone)]), 0.2)
          << name(bone);
    }
  }
}

TEST(StandingRest, KeepsEveryPosture) {
  Motion walk = walk_with_odd_rest(5);
  const Skeleton found = standing_rest(walk);
  const auto before = world_from_joints(walk.skeleton, walk.poses[40]);
  const auto after = world_from_joints(found, walk.poses[40]);
  for (std::size_t j = 0; j < before.size(); ++j) {
    EXPECT_EQ(before[j].translation, after[j].translation);
  }
}

// Where it walks, and which way, is not how it is built.
TEST(StandingRest, IsTheSameWhicheverWayTheBodyWalks) {
  Motion walk = walk_with_odd_rest(6);
  const Skeleton one = standing_rest(walk);
  const glm::dquat turn = glm::angleAxis(2.0, glm::dvec3(0, 1, 0));
  for (Pose& pose : walk.poses) {
    pose.root_in_world = turn * pose.root_in_world + glm::dvec3(3.0, 0.0, -5.0);
    pose.parent_from_joint[0] = turn * pose.parent_from_joint[0];
  }
  const Skeleton other = standing_rest(walk);
  for (std::size_t j = 0; j < one.joints.size(); ++j) {
    EXPECT_LT(apart_rad(one.joints[j].parent_from_joint.rotation,
                        other.joints[j].parent_from_joint.rotation),
              1e-9);
  }
}

}  // namespace
}  // namespace marey::retarget
