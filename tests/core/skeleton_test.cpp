// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/skeleton.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"

namespace marey {
namespace {

using B = HumanBone;

constexpr double kRounding_m = 1e-12;  // A sum of ten lengths of a metre or less.

std::vector<RigidTransform> t_pose(const Proportions& proportions) {
  const Skeleton skeleton = make_humanoid(proportions);
  return world_from_joints(skeleton, rest_pose(skeleton));
}

glm::dvec3 reflected(const glm::dvec3& v) {
  return {-v.x, v.y, v.z};
}

TEST(AverageProportions, HaveTheGivenStature) {
  for (const double stature_m : {0.9, 1.75, 2.2}) {
    const Proportions p = average_proportions(stature_m);
    const auto world = t_pose(p);
    const glm::dvec3 crown = world[index(B::kHead)] * p.head_top_in_head;
    EXPECT_NEAR(crown.y, stature_m, kRounding_m);
  }
}

TEST(AverageProportions, StandWithTheSolesOnTheFloor) {
  const double stature_m = 1.75;
  const Proportions p = average_proportions(stature_m);
  const auto world = t_pose(p);
  for (const B toes : {B::kLeftToes, B::kRightToes}) {
    // A toe joint is half a toe's thickness above the sole: one or two centimetres.
    EXPECT_GT(world[index(toes)].translation.y, 0.01);
    EXPECT_LT(world[index(toes)].translation.y, 0.03);
  }
}

TEST(AverageProportions, AreAlikeOnBothSides) {
  const Proportions p = average_proportions(1.6);
  for (const B bone : human_bones()) {
    EXPECT_EQ(p[mirrored(bone)], reflected(p[bone])) << name(bone);
  }
  EXPECT_EQ(p.right_hand_tip_in_hand, reflected(p.left_hand_tip_in_hand));
  EXPECT_EQ(p.right_toe_tip_in_toes, reflected(p.left_toe_tip_in_toes));
}

TEST(AverageProportions, GrowWithTheStature) {
  const Proportions small = average_proportions(1.0);
  const Proportions large = average_proportions(2.0);
  for (const B bone : human_bones()) {
    EXPECT_LT(glm::distance(large[bone], 2.0 * small[bone]), kRounding_m);
  }
}

TEST(AverageProportions, HaveTheLimbsOfWintersFigure) {
  const Proportions p = average_proportions(1.0);
  EXPECT_NEAR(glm::length(p[B::kLeftLowerArm]), 0.186, kRounding_m);
  EXPECT_NEAR(glm::length(p[B::kLeftHand]), 0.146, kRounding_m);
  EXPECT_NEAR(glm::length(p[B::kLeftLowerLeg]), 0.530 - 0.285, kRounding_m);
  EXPECT_NEAR(glm::length(p[B::kLeftFoot]), 0.285 - 0.039, kRounding_m);
}

TEST(MakeHumanoid, NumbersItsJointsAsTheBones) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  ASSERT_EQ(skeleton.joints.size(), human_bones().size());
  for (const B bone : human_bones()) {
    const Joint& joint = skeleton.joints[index(bone)];
    EXPECT_EQ(joint.bone, bone);
    EXPECT_EQ(joint.name, name(bone));
    EXPECT_EQ(joint.parent.has_value(), parent(bone).has_value());
    if (joint.parent) {
      EXPECT_EQ(index(*joint.parent), index(*parent(bone)));
    }
  }
}

TEST(MakeHumanoid, FacesForwardWithItsLeftHandTowardsX) {
  const auto world = t_pose(average_proportions(1.75));
  EXPECT_GT(world[index(B::kLeftHand)].translation.x, 0.5);
  EXPECT_LT(world[index(B::kRightHand)].translation.x, -0.5);
  EXPECT_GT(world[index(B::kLeftToes)].translation.z, 0.1);
}

TEST(ProportionsOf, UndoesMakeHumanoid) {
  Proportions p = average_proportions(1.75);
  p[B::kLeftFoot] += glm::dvec3(0.01, 0.02, 0.03);
  p.right_hand_tip_in_hand *= 1.1;
  const Proportions back = proportions_of(make_humanoid(p));
  EXPECT_EQ(back.offset_in_parent, p.offset_in_parent);
  EXPECT_EQ(back.head_top_in_head, p.head_top_in_head);
  EXPECT_EQ(back.left_hand_tip_in_hand, p.left_hand_tip_in_hand);
  EXPECT_EQ(back.right_hand_tip_in_hand, p.right_hand_tip_in_hand);
  EXPECT_EQ(back.left_toe_tip_in_toes, p.left_toe_tip_in_toes);
  EXPECT_EQ(back.right_toe_tip_in_toes, p.right_toe_tip_in_toes);
}

TEST(SkeletonFind, FindsAJointByBoneAndByName) {
  const Skeleton skeleton = make_humanoid(average_proportions(1.75));
  EXPECT_EQ(skeleton.find(B::kLeftFoot), JointIndex{static_cast<int>(B::kLeftFoot)});
  EXPECT_EQ(skeleton.find("leftFoot"), skeleton.find(B::kLeftFoot));
}

TEST(SkeletonFind, ReturnsNothingForAnUnknownName) {
  Skeleton skeleton = make_humanoid(average_proportions(1.75));
  skeleton.joints.pop_back();
  EXPECT_FALSE(skeleton.find(B::kRightToes));
  EXPECT_FALSE(skeleton.find("tail"));
}

TEST(LegLength, IsTheMeanOfBothLegs) {
  Proportions p = average_proportions(1.0);
  p[B::kLeftFoot].y -= 0.02;
  EXPECT_NEAR(leg_length_m(p), 0.245 + 0.246 + 0.01, kRounding_m);
}

}  // namespace
}  // namespace marey
