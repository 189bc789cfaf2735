// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/reparent_bones.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/bones/identify_bones.h"
#include "tests/retarget/named_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

Skeleton mixamo_skeleton() {
  return sided_body({"Hips",
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
                     "{side}ToeBase"},
                    "Left",
                    "Right");
}

/// Moves bones below an added root on the floor; rest positions stay.
Skeleton hung_on_root(const Skeleton& body, const std::vector<std::string>& names) {
  const auto world = world_from_joints(body, rest_pose(body));
  Skeleton out;
  Joint root;
  root.name = "Root";
  out.joints.push_back(root);
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    Joint joint = body.joints[i];
    const bool is_off =
        !joint.parent || std::ranges::find(names, joint.name) != names.end();
    joint.parent = JointIndex{is_off ? 0 : static_cast<int>(index(*joint.parent)) + 1};
    if (is_off) joint.parent_from_joint = world[i];
    out.joints.push_back(joint);
  }
  return out;
}

std::string reparented_joint_of(const ReparentedBody& body, B bone) {
  const auto joint = body.found.joint(bone);
  return joint ? body.skeleton[*joint].name : "";
}

std::string parent_of(const ReparentedBody& body, B bone) {
  const auto joint = body.found.joint(bone);
  const auto above = joint ? body.skeleton[*joint].parent : std::nullopt;
  return above ? body.skeleton[*above].name : "";
}

ReparentedBody hung(const Skeleton& body,
                    const BoneMap& overrides = {},
                    const std::vector<bool>& skin = {}) {
  const auto found = identify_bones(body, overrides);
  EXPECT_TRUE(found) << found.error().message();
  if (!found) return {};
  auto made = reparent_to_carriers(body, *found, skin);
  EXPECT_TRUE(made) << made.error().message();
  EXPECT_TRUE(made && *made);
  return made && *made ? **made : ReparentedBody{};
}

TEST(HangBones, LeavesABodyAloneThatHangsTogether) {
  const Skeleton body = mixamo_skeleton();
  const auto made = reparent_to_carriers(body, *identify_bones(body), {});
  ASSERT_TRUE(made);
  EXPECT_FALSE(*made);
}

TEST(HangBones, HangsFeetOnTheirShins) {
  const ReparentedBody body =
      hung(hung_on_root(mixamo_skeleton(), {"LeftFoot", "RightFoot"}));
  EXPECT_EQ(reparented_joint_of(body, B::kLeftFoot), "LeftFoot");
  EXPECT_EQ(parent_of(body, B::kLeftFoot), "LeftLeg");
  EXPECT_EQ(parent_of(body, B::kRightFoot), "RightLeg");
  EXPECT_EQ(reparented_joint_of(body, B::kRightToes), "RightToeBase");
}

// The joint at the end of a shin is not the foot if there is another foot.
TEST(HangBones, PrefersTheFootToTheEndOfTheShin) {
  Skeleton body = hung_on_root(mixamo_skeleton(), {"LeftFoot", "RightFoot"});
  for (const std::string side : {"Left", "Right"}) {
    Joint end;
    end.name = side + "Leg_end";
    end.parent = body.find(side + "Leg");
    const auto world = world_from_joints(body, rest_pose(body));
    end.parent_from_joint =
        inverse(world[index(*end.parent)]) * world[index(*body.find(side + "Foot"))];
    body.joints.push_back(end);
  }
  const ReparentedBody made = hung(body);
  EXPECT_EQ(reparented_joint_of(made, B::kLeftFoot), "LeftFoot");
  EXPECT_EQ(parent_of(made, B::kLeftFoot), "LeftLeg");
}

TEST(HangBones, TakesHipsThatCarryTheSpineForARootOnTheFloor) {
  const ReparentedBody body =
      hung(hung_on_root(mixamo_skeleton(), {"LeftUpLeg", "RightUpLeg"}));
  EXPECT_EQ(reparented_joint_of(body, B::kHips), "Hips");
  EXPECT_EQ(parent_of(body, B::kLeftUpperLeg), "Hips");
  EXPECT_EQ(parent_of(body, B::kRightUpperLeg), "Hips");
}

// Rigs whose deforming bones have no parents are exported like this.
TEST(HangBones, HangsTogetherABodyInPieces) {
  const Skeleton read = hung_on_root(mixamo_skeleton(),
                                     {"LeftUpLeg",
                                      "RightUpLeg",
                                      "LeftShoulder",
                                      "RightShoulder",
                                      "LeftArm",
                                      "RightArm"});
  const ReparentedBody body = hung(read);
  EXPECT_EQ(parent_of(body, B::kLeftShoulder), "Spine2");
  EXPECT_EQ(parent_of(body, B::kRightUpperArm), "RightShoulder");
  const auto before = world_from_joints(read, rest_pose(read));
  const auto after = world_from_joints(body.skeleton, rest_pose(body.skeleton));
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_TRUE(body.read_joint[i]);
    EXPECT_LT(glm::distance(after[i].translation,
                            before[index(*body.read_joint[i])].translation),
              1e-12);
  }
  Skeleton marked = body.skeleton;
  mark(body.found, marked);
  EXPECT_TRUE(map_body(marked));
}

// Skin left on the root would not follow the body.
TEST(HangBones, AttachesJointsWithSkinToTheNearestBone) {
  Skeleton body = hung_on_root(mixamo_skeleton(), {"LeftUpLeg", "RightUpLeg"});
  const auto world = world_from_joints(body, rest_pose(body));
  const auto add = [&](const char* joint, const char* neighbour) {
    Joint extra;
    extra.name = joint;
    extra.parent = JointIndex{0};
    extra.parent_from_joint.translation =
        world[index(*body.find(std::string_view(neighbour)))].translation + 0.01;
    body.joints.push_back(extra);
  };
  add("jaw", "Head");
  add("belly", "Hips");
  add("handle", "Head");
  std::vector<bool> skin(body.joints.size(), true);
  skin.back() = false;
  const ReparentedBody made = hung(body, {}, skin);
  const auto carrier = [&](std::string_view joint) {
    return made.skeleton[*made.skeleton[*made.skeleton.find(joint)].parent].name;
  };
  EXPECT_EQ(carrier("jaw"), "Head");
  EXPECT_EQ(carrier("belly"), "Hips");
  EXPECT_EQ(carrier("handle"), "Root");
}

// The map that the error requests.
TEST(HangBones, AttachesTheBonesThatAMapNames) {
  Skeleton body = hung_on_root(mixamo_skeleton(), {"LeftLeg", "RightLeg"});
  EXPECT_FALSE(identify_bones(body));
  BoneMap overrides;
  overrides.bones[index(B::kLeftLowerLeg)] = {true, body.find("LeftLeg")};
  overrides.bones[index(B::kRightLowerLeg)] = {true, body.find("RightLeg")};
  const ReparentedBody made = hung(body, overrides);
  EXPECT_EQ(parent_of(made, B::kLeftLowerLeg), "LeftUpLeg");
}

TEST(HangBones, MakesAFootWhereAMapStatesThatThereIsNone) {
  const Skeleton body = mixamo_skeleton();
  BoneMap overrides;
  for (const B bone : {B::kLeftFoot, B::kLeftToes, B::kRightFoot, B::kRightToes}) {
    overrides.bones[index(bone)].is_set = true;
  }
  const ReparentedBody made = hung(body, overrides);
  EXPECT_EQ(reparented_joint_of(made, B::kLeftFoot), "LeftLeg_foot");
  const auto foot = *made.found.joint(B::kLeftFoot);
  EXPECT_FALSE(made.read_joint[index(foot)]);
  const auto world = world_from_joints(made.skeleton, rest_pose(made.skeleton));
  const auto before = world_from_joints(body, rest_pose(body));
  EXPECT_LT(glm::distance(world[index(foot)].translation,
                          before[index(*body.find("LeftFoot"))].translation),
            1e-12);
  Skeleton marked = made.skeleton;
  mark(made.found, marked);
  EXPECT_TRUE(map_body(marked));
}

TEST(HangBones, DeclinesBonesThatCarryEachOther) {
  const Skeleton body = mixamo_skeleton();
  BoneMap overrides;
  overrides.bones[index(B::kLeftLowerLeg)] = {true, body.find("LeftFoot")};
  overrides.bones[index(B::kLeftFoot)] = {true, body.find("LeftLeg")};
  const auto found = identify_bones(body, overrides);
  ASSERT_FALSE(found);
  EXPECT_EQ(
      found.error().cause,
      "'LeftLeg' is identified as leftFoot but is above 'LeftFoot', the leftLowerLeg");
}

// A motion keeps its joints' positions and rotations.
TEST(HangBones, PutsAMotionOnTheHungBody) {
  const Skeleton read = hung_on_root(mixamo_skeleton(), {"LeftUpLeg", "RightUpLeg"});
  const ReparentedBody body = hung(read);
  testing::Dice dice(4);
  Motion motion{read, FrameRate{30.0}, 0, {}};
  Pose pose = rest_pose(read);
  for (glm::dquat& turn : pose.parent_from_joint) turn = turn * dice.turn(0.7);
  motion.poses.push_back(pose);
  const auto before = world_from_joints(read, pose);
  convert_to_reparented(body, motion);
  const auto after = world_from_joints(motion.skeleton, motion.poses[0]);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const glm::dquat& then = before[index(*body.read_joint[i])].rotation;
    EXPECT_GT(std::abs(glm::dot(after[i].rotation, then)), 1.0 - 1e-12);
  }
}

}  // namespace
}  // namespace marey::retarget
