// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/identify_bones.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/retarget/named_bodies.h"
#include "tests/support/bodies/quadruped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using BoneNames = std::vector<std::string>;

std::string joint_of(const Skeleton& body, const FoundBones& found, B bone) {
  const auto joint = found.joint(bone);
  return joint ? body[*joint].name : "";
}

std::string refusal_cause(const Skeleton& body, const BoneMap& overrides = {}) {
  const auto found = identify_bones(body, overrides);
  EXPECT_FALSE(found);
  return found ? "" : found.error().cause;
}

BoneNames mixamo() {
  return {"Hips",
          "Spine",
          "Spine1",
          "Spine2",
          "Neck",
          "Head",
          "{side}Shoulder",
          "{side}Arm",
          "{side}ForeArm",
          "{side}Hand",
          "{side}UpLeg",
          "{side}Leg",
          "{side}Foot",
          "{side}ToeBase"};
}

Skeleton mixamo_body() {
  return sided_body(mixamo(), "Left", "Right");
}

TEST(IdentifyBones, PassesOverTwistAndHelperJoints) {
  Skeleton body = with_joint_above(mixamo_body(), "LeftLeg", "LeftUpLegTwist", 0.5);
  body = with_joint_above(body, "LeftForeArm", "LeftArmTwist", 0.5);
  body = with_joint_above(body, "LeftUpLeg", "LHipJoint", 0.0);
  body = with_joint_above(body, "RightUpLeg", "RHipJoint", 0.0);
  const auto found = identify_bones(body);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(found->scheme, "CMU, MotionBuilder");
  EXPECT_EQ(joint_of(body, *found, B::kLeftUpperLeg), "LeftUpLeg");
  EXPECT_EQ(joint_of(body, *found, B::kLeftLowerLeg), "LeftLeg");
  EXPECT_EQ(joint_of(body, *found, B::kLeftLowerArm), "LeftForeArm");
  EXPECT_EQ(joint_of(body, *found, B::kHips), "Hips");
}

TEST(IdentifyBones, SharesOutAnyNumberOfVertebrae) {
  for (int count = 1; count <= 6; ++count) {
    Skeleton body =
        testing::with_vertebrae(make_humanoid(average_proportions(1.75)), count);
    for (Joint& joint : body.joints) {
      if (joint.bone) joint.name = std::string(name(*joint.bone));
      joint.bone.reset();
    }
    const auto found = identify_bones(body);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_EQ(joint_of(body, *found, B::kSpine), "vertebra1");
    EXPECT_EQ(found->joint(B::kChest).has_value(), count > 1);
    EXPECT_EQ(found->joint(B::kUpperChest).has_value(), count > 2);
    const B top = count > 2 ? B::kUpperChest : (count > 1 ? B::kChest : B::kSpine);
    EXPECT_EQ(joint_of(body, *found, top), "vertebra" + std::to_string(count));
    EXPECT_EQ(joint_of(body, *found, B::kNeck), "neck");
  }
}

TEST(IdentifyBones, TakesTheJointThatCarriesLegsAndSpineForHips) {
  // As in bipeds whose thighs are children of the first spine joint.
  Skeleton body = mixamo_body();
  for (Joint& joint : body.joints) {
    if (joint.name.ends_with("UpLeg")) joint.parent = body.find("Spine");
  }
  const auto found = identify_bones(body);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(joint_of(body, *found, B::kHips), "Spine");
  ASSERT_FALSE(found->remarks.empty());
  EXPECT_NE(found->remarks[0].find("'Hips' has the name of the hips"), std::string::npos);
}

TEST(IdentifyBones, IdentifiesABodyWithoutNamesByItsShape) {
  const Skeleton truth = make_humanoid(average_proportions(1.75));
  Skeleton body = truth;
  for (Joint& joint : body.joints) {
    joint.name.clear();
    joint.bone.reset();
  }
  const auto found = identify_bones(body);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(found->scheme, "no names");
  for (const B bone : human_bones()) {
    ASSERT_TRUE(found->joint(bone)) << name(bone);
    // The front alone decides which side is left.
    const B there = *truth[*found->joint(bone)].bone;
    EXPECT_TRUE(there == bone || there == mirrored(bone)) << name(bone);
    EXPECT_EQ(found->bones[index(bone)]->evidence, BoneEvidence::kShape);
    EXPECT_LT(found->bones[index(bone)]->confidence, 0.8);
  }
}

TEST(IdentifyBones, KeepsTheMarksOfAFile) {
  Skeleton body = make_humanoid(average_proportions(1.6));
  for (Joint& joint : body.joints) joint.name = "x" + joint.name;
  const auto found = identify_bones(body);
  ASSERT_TRUE(found);
  for (const B bone : human_bones()) {
    EXPECT_EQ(found->bones[index(bone)]->evidence, BoneEvidence::kFile);
    EXPECT_EQ(found->bones[index(bone)]->confidence, 1.0);
    EXPECT_EQ(body[*found->joint(bone)].bone, bone);
  }
}

TEST(IdentifyBones, PrefersTheMapOfTheUser) {
  Skeleton body = mixamo_body();
  body.joints[index(*body.find("LeftUpLeg"))].name = "Oberschenkel";
  BoneMap overrides;
  overrides.bones[index(B::kLeftUpperLeg)] = {true, body.find("Oberschenkel")};
  overrides.bones[index(B::kLeftToes)] = {true, std::nullopt};
  const auto found = identify_bones(body, overrides);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(joint_of(body, *found, B::kLeftUpperLeg), "Oberschenkel");
  EXPECT_EQ(found->bones[index(B::kLeftUpperLeg)]->evidence, BoneEvidence::kUser);
  EXPECT_FALSE(found->joint(B::kLeftToes));
  EXPECT_EQ(joint_of(body, *found, B::kRightToes), "RightToeBase");
}

// A map may state for every bone that the body has none.
TEST(IdentifyBones, DeclinesABodyWhoseMapExcludesHipsOrAllBones) {
  const Skeleton body = mixamo_body();
  Skeleton nameless = body;
  for (std::size_t i = 0; i < nameless.joints.size(); ++i) {
    nameless.joints[i].name = std::to_string(i);
  }
  BoneMap no_hips;
  no_hips.bones[index(B::kHips)].is_set = true;
  BoneMap nothing;
  for (BoneOverride& bone : nothing.bones) bone.is_set = true;
  for (const Skeleton& one : {body, nameless}) {
    EXPECT_NE(refusal_cause(one, no_hips), "");
    EXPECT_NE(refusal_cause(one, nothing), "");
  }
}

TEST(IdentifyBones, FindsTheFootThatALegLeadsTo) {
  // Feet of a rig for inverse kinematics are children of the root.
  Skeleton body = mixamo_body();
  for (const std::string side : {"Left", "Right"}) {
    Joint end = body.joints[index(*body.find(side + "Foot"))];
    end.name = side + "Leg_end";
    body.joints.push_back(end);
    Joint& foot = body.joints[index(*body.find(side + "Foot"))];
    foot.parent = JointIndex{0};
  }
  const auto found = identify_bones(body);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(joint_of(body, *found, B::kLeftFoot), "LeftLeg_end");
  EXPECT_LT(found->bones[index(B::kLeftFoot)]->confidence, 0.7);
}

TEST(IdentifyBones, DeclinesTwoBodiesNamingTheJoints) {
  Skeleton body = mixamo_body();
  const std::size_t count = body.joints.size();
  for (std::size_t i = 0; i < count; ++i) {
    Joint joint = body.joints[i];
    joint.parent = joint.parent
                       ? JointIndex{index(*joint.parent) == 0
                                        ? static_cast<int>(count)
                                        : static_cast<int>(index(*joint.parent) + count)}
                       : JointIndex{0};
    body.joints.push_back(joint);
  }
  const std::string said = refusal_cause(body);
  EXPECT_NE(said.find("two joints have the name of a body's"), std::string::npos) << said;
  EXPECT_NE(said.find("'Neck' below 'Spine2'"), std::string::npos) << said;
}

TEST(IdentifyBones, DeclinesBonesThatDoNotHangOnEachOther) {
  Skeleton body = mixamo_body();
  body.joints[index(*body.find("LeftLeg"))].parent = JointIndex{0};
  EXPECT_EQ(refusal_cause(body),
            "'LeftLeg' is identified as leftLowerLeg but is not below 'LeftUpLeg', the "
            "leftUpperLeg");
}

TEST(IdentifyBones, DeclinesLegsThatAreNoPair) {
  Skeleton body = mixamo_body();
  for (const char* joint : {"LeftLeg", "LeftFoot"}) {
    body.joints[index(*body.find(joint))].parent_from_joint.translation *= 0.4;
  }
  EXPECT_EQ(refusal_cause(body),
            "the leg that ends at 'LeftFoot' has only 40 % of the other's length");
}

TEST(IdentifyBones, DeclinesASkeletonThatIsNoBody) {
  Skeleton boxes;
  for (int i = 0; i < 5; ++i) {
    Joint joint;
    joint.name = "box" + std::to_string(i);
    if (i > 0) joint.parent = JointIndex{0};
    joint.parent_from_joint.translation = {0.1 * i, 0, 0};
    boxes.joints.push_back(joint);
  }
  EXPECT_EQ(
      refusal_cause(boxes),
      "no body was found among its 5 joints: no joint has two legs below it and two "
      "arms above");
  EXPECT_EQ(refusal_cause(Skeleton{}), "it has no joints");
}

// A chain of ten thousand joints, and a star of as many: no recursion, no quadratic cost.
TEST(IdentifyBones, TakesTenThousandJoints) {
  for (const bool chain : {true, false}) {
    Skeleton body = mixamo_body();
    const int head = static_cast<int>(index(*body.find("Head")));
    while (body.joints.size() < 10000) {
      Joint hair;
      hair.name = "hair" + std::to_string(body.joints.size());
      const int last = static_cast<int>(body.joints.size()) - 1;
      hair.parent = JointIndex{chain && last > 21 ? last : head};
      hair.parent_from_joint.translation = {0, 0.00001, 0};
      body.joints.push_back(hair);
    }
    const auto found = identify_bones(body);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_EQ(joint_of(body, *found, B::kLeftHand), "LeftHand");
    for (Joint& joint : body.joints) joint.name.clear();
    EXPECT_TRUE(identify_bones(body));
  }
}

}  // namespace
}  // namespace marey::retarget
