// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/gltf/vrma.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf.h"
#include "tests/recordings/wild_motion.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

// Floats, of which some dozen are multiplied.
constexpr double kRounding_m = 2e-6;

Skeleton uneven_body() {
  return make_humanoid(uneven(average_proportions(1.75)));
}

nlohmann::json json_of(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  return nlohmann::json::parse(glb.substr(20, size));
}

Motion read_again(const ScratchFolder& folder,
                  const Motion& motion,
                  const VrmaOptions& options = {}) {
  EXPECT_TRUE(write_vrma(folder / "a.vrma", motion, options));
  const auto read = read_character(folder / "a.vrma");
  EXPECT_TRUE(read) << read.error().message();
  return read && read->motion ? *read->motion : Motion{};
}

std::string write_refusal(const Motion& motion) {
  const auto bytes = vrma_bytes(motion);
  return bytes ? "no refusal" : bytes.error().message();
}

TEST(Vrma, KeepsEveryBoneInItsPlace) {
  const ScratchFolder folder;
  const Motion motion = wild_motion(uneven_body(), 40);
  EXPECT_LT(largest_distance_m(motion, read_again(folder, motion)), kRounding_m);
}

TEST(Vrma, KeepsTheRate) {
  const ScratchFolder folder;
  for (const double hz : {24.0, 29.97, 30000.0 / 1001.0, 30.0, 60.0, 119.88, 120.0}) {
    Motion motion = wild_motion(uneven_body(), 200);
    motion.rate.hz = hz;
    EXPECT_EQ(read_again(folder, motion).rate.hz, hz);
  }
}

// The result does not depend on the axes of the source's bones.
TEST(Vrma, RestsWithoutRotationsWhateverTheSkeletonRestsWith) {
  const ScratchFolder folder;
  const Motion motion = wild_motion(with_turned_axes(uneven_body()), 20);
  const Motion read = read_again(folder, motion);
  for (const Joint& joint : read.skeleton.joints) {
    EXPECT_EQ(joint.parent_from_joint.rotation, glm::dquat(1, 0, 0, 0)) << joint.name;
  }
  EXPECT_LT(largest_distance_m(motion, read), kRounding_m);
}

// A neck of two joints, of which VRM has one: it points towards the head.
TEST(Vrma, TurnsABoneForJointsThatVrmDoesNotHave) {
  const ScratchFolder folder;
  Motion motion = wild_motion(uneven_body(), 40);
  Skeleton& body = motion.skeleton;
  const JointIndex upper_neck = *body.find(HumanBone::kHead);
  const JointIndex neck = *body.find(HumanBone::kNeck);
  Joint head = body[upper_neck];
  Joint& between = body.joints[index(upper_neck)];
  between.name = "neck1";
  between.bone.reset();
  between.parent_from_joint.translation *= 0.5;
  between.tip_in_joint.reset();
  head.parent = upper_neck;
  head.parent_from_joint.translation = between.parent_from_joint.translation;
  head.parent_from_joint.rotation = {1, 0, 0, 0};
  body.joints.push_back(head);
  for (Pose& pose : motion.poses) pose.parent_from_joint.push_back({1, 0, 0, 0});
  const Motion read = read_again(folder, motion);
  ASSERT_EQ(read.poses.size(), motion.poses.size());
  double max_m = 0.0;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const auto solved = world_from_joints(body, motion.poses[t]);
    const auto file = world_from_joints(read.skeleton, read.poses[t]);
    const glm::dvec3 base = solved[index(neck)].translation;
    const glm::dvec3 way = solved.back().translation - base;
    const glm::dvec3 own =
        file[index(*read.skeleton.find(HumanBone::kHead))].translation - base;
    EXPECT_LT(glm::length(glm::cross(glm::normalize(way), own)), 1e-5);
    EXPECT_GT(glm::dot(way, own), 0.0);
    max_m = std::max(max_m, std::abs(glm::length(way) - glm::length(own)));
  }
  EXPECT_GT(max_m, 0.0) << "the format cannot store its distance";
}

// A body whose rest pose has a hanging left arm, with a given T-pose.
TEST(Vrma, IsRelativeToTheGivenTPose) {
  const ScratchFolder folder;
  const Skeleton t_posed = uneven_body();
  const auto upper = t_posed.find(HumanBone::kLeftUpperArm);
  ASSERT_TRUE(upper);
  Motion motion;
  motion.skeleton = t_posed;
  // At rest the arm hangs: its bones' offsets are rotated, their axes are not.
  const glm::dquat hang = rotation_from_vector({0.0, 0.0, -1.3});
  std::vector<glm::dquat> t_pose(t_posed.joints.size(), glm::dquat(1, 0, 0, 0));
  for (std::size_t i = 0; i < t_pose.size(); ++i) {
    bool below = false;
    for (auto at = t_posed.joints[i].parent; at; at = t_posed[*at].parent) {
      below = below || *at == *upper;
    }
    if (below)
      motion.skeleton.joints[i].parent_from_joint.translation =
          hang * t_posed.joints[i].parent_from_joint.translation;
    if (below || i == index(*upper)) t_pose[i] = glm::conjugate(hang);
  }
  motion.poses = {rest_pose(motion.skeleton), rest_pose(t_posed)};
  motion.poses[1].parent_from_joint[index(*upper)] = glm::conjugate(hang);
  const Motion read = read_again(folder, motion, {.t_pose_from_joint = t_pose});
  for (std::size_t i = 0; i < read.skeleton.joints.size(); ++i) {
    const auto there = t_posed.find(read.skeleton.joints[i].name);
    ASSERT_TRUE(there);
    EXPECT_LT(glm::distance(read.skeleton.joints[i].parent_from_joint.translation,
                            t_posed[*there].parent_from_joint.translation),
              1e-6)
        << read.skeleton.joints[i].name;
    EXPECT_LT(glm::angle(read.poses.at(1).parent_from_joint[i]), 1e-6);
  }
  EXPECT_LT(largest_distance_m(motion, read), kRounding_m);
}

TEST(Vrma, HasTheFieldsThatTheFormatRequires) {
  const Motion motion = wild_motion(uneven_body(), 30);
  const auto bytes = vrma_bytes(motion, {.t_pose_from_joint = {}, .clip = "jump"});
  ASSERT_TRUE(bytes);
  const auto json = json_of(*bytes);
  EXPECT_EQ(json["extensionsUsed"], nlohmann::json({"VRMC_vrm_animation"}));
  const auto& extension = json["extensions"]["VRMC_vrm_animation"];
  EXPECT_EQ(extension["specVersion"], "1.0");
  EXPECT_EQ(extension["humanoid"]["humanBones"].size(), 22U);
  ASSERT_EQ(json["animations"].size(), 1U);
  EXPECT_EQ(json["animations"][0]["name"], "jump");
  const auto hips = extension["humanoid"]["humanBones"]["hips"]["node"];
  std::map<std::string, int> paths;
  for (const auto& channel : json["animations"][0]["channels"]) {
    const std::string path = channel["target"]["path"];
    ++paths[path];
    if (path == "translation") {
      EXPECT_EQ(channel["target"]["node"], hips);
    }
  }
  EXPECT_EQ(paths, (std::map<std::string, int>{{"rotation", 22}, {"translation", 1}}));
  EXPECT_EQ(*bytes, *vrma_bytes(motion, {.t_pose_from_joint = {}, .clip = "jump"}));
}

// Linear blending between neighbours takes the short way only with equal signs.
TEST(Vrma, KeepsNeighbouringQuaternionsOnOneSide) {
  Motion motion = wild_motion(uneven_body(), 50);
  for (std::size_t i = 0; i < motion.poses.size(); i += 2) {
    for (glm::dquat& q : motion.poses[i].parent_from_joint) q = -q;
  }
  const auto bytes = vrma_bytes(motion);
  ASSERT_TRUE(bytes);
  const auto json = json_of(*bytes);
  const std::size_t data = bytes->find("BIN") + 4;
  for (const auto& sampler : json["animations"][0]["samplers"]) {
    const auto& accessor = json["accessors"][sampler["output"].get<std::size_t>()];
    if (accessor["type"] != "VEC4") continue;
    const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<float> keys(4 * motion.poses.size());
    std::memcpy(keys.data(),
                bytes->data() + data + view["byteOffset"].get<std::size_t>(),
                keys.size() * sizeof(float));
    for (std::size_t i = 4; i < keys.size(); i += 4) {
      float dot = 0.0F;
      for (std::size_t k = 0; k < 4; ++k) dot += keys[i + k] * keys[i + k - 4];
      EXPECT_GE(dot, 0.0F);
    }
  }
}

// The rotations of helper joints are applied to the bones below them.
TEST(Vrma, AppliesRotationsOfHelperJointsToTheBonesBelow) {
  const ScratchFolder folder;
  Motion motion = wild_motion(uneven_body(), 20);
  const auto chest = motion.skeleton.find(HumanBone::kUpperChest);
  ASSERT_TRUE(chest);
  motion.skeleton.joints[index(*chest)].bone.reset();
  const Motion read = read_again(folder, motion);
  ASSERT_EQ(read.skeleton.joints.size(), motion.skeleton.joints.size() - 1);
  const auto hand = motion.skeleton.find(HumanBone::kLeftHand);
  const auto there = read.skeleton.find(HumanBone::kLeftHand);
  ASSERT_TRUE(hand && there);
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    const auto a = world_from_joints(motion.skeleton, motion.poses[i])[index(*hand)];
    const auto b = world_from_joints(read.skeleton, read.poses[i])[index(*there)];
    EXPECT_GT(std::abs(glm::dot(a.rotation, b.rotation)), 1.0 - 1e-10);
  }
}

// A file of three-vrm, of 51 bones: marey's bones keep their positions.
TEST(Vrma, KeepsARealOneWhenWrittenAgain) {
  const auto path = marey::testing::shared_data() / "avatars/threevrm/test.vrma";
  if (!exists(path)) GTEST_SKIP() << path << " is missing";
  const ScratchFolder folder;
  const auto real = read_character(path);
  ASSERT_TRUE(real && real->motion);
  const Motion& motion = *real->motion;
  const Motion read = read_again(folder, motion);
  EXPECT_EQ(read.rate.hz, motion.rate.hz);
  ASSERT_EQ(read.poses.size(), motion.poses.size());
  for (std::size_t i = 0; i < motion.poses.size(); ++i) {
    const auto a = world_from_joints(motion.skeleton, motion.poses[i]);
    const auto b = world_from_joints(read.skeleton, read.poses[i]);
    for (const HumanBone bone : human_bones()) {
      const auto in_a = motion.skeleton.find(bone);
      const auto in_b = read.skeleton.find(bone);
      ASSERT_EQ(in_a.has_value(), in_b.has_value()) << name(bone);
      if (!in_a) continue;
      EXPECT_LT(glm::distance(a[index(*in_a)].translation, b[index(*in_b)].translation),
                1e-5)
          << name(bone);
    }
  }
}

TEST(Vrma, RefusesABodyWithoutTheBonesThatVrmRequires) {
  Motion motion = wild_motion(uneven_body(), 1);
  motion.skeleton.joints[index(*motion.skeleton.find(HumanBone::kLeftHand))].bone.reset();
  EXPECT_NE(write_refusal(motion).find("no joint is the leftHand, which VRM requires"),
            std::string::npos);
  motion = wild_motion(uneven_body(), 1);
  const auto left = motion.skeleton.find(HumanBone::kLeftFoot);
  const auto right = motion.skeleton.find(HumanBone::kRightFoot);
  motion.skeleton.joints[index(*left)].bone = HumanBone::kRightFoot;
  motion.skeleton.joints[index(*right)].bone = HumanBone::kLeftFoot;
  EXPECT_NE(
      write_refusal(motion).find("the leftFoot does not lie below the leftLowerLeg"),
      std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
