// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/read_body.h"

#include <algorithm>
#include <array>
#include <fstream>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/motion/retarget_files.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/mannequin.h"
#include "recordings/motion/bvh.h"
#include "retarget/body/body_map.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using B = HumanBone;
using testing::ScratchFolder;

std::filesystem::path body_file(const std::string& name) {
  return marey::testing::shared_data() / name;
}

struct FileCase {
  const char* file;
  const char* scheme;
  const char* left_knee;
  const char* right_hand;
  double low_m;  ///< Bounds of the stature, computed from the bones.
  double high_m;
};

class EveryFile : public ::testing::TestWithParam<FileCase> {};

/// Expects conditions that hold for any body in marey's frame, independent of its names.
void expect_stands(const Skeleton& body) {
  const auto world = world_from_joints(body, rest_pose(body));
  const auto at = [&](B bone) {
    const auto joint = body.find(bone);
    EXPECT_TRUE(joint) << name(bone);
    return joint ? world[index(*joint)].translation : glm::dvec3(0.0);
  };
  EXPECT_GT(at(B::kHead).y, at(B::kLeftUpperArm).y);
  EXPECT_GT(at(B::kHead).y, at(B::kHips).y);
  EXPECT_GT(at(B::kLeftUpperArm).y, at(B::kHips).y);
  for (const HumanLimb& limb : human_limbs()) {
    const double side = index(limb.upper) < index(mirrored(limb.upper)) ? 1.0 : -1.0;
    EXPECT_GT(side * (at(limb.upper).x - at(mirrored(limb.upper)).x), 0.02);
    if (limb.upper < B::kLeftUpperLeg) continue;
    EXPECT_GT(at(limb.upper).y, at(limb.lower).y + 0.1);
    EXPECT_GT(at(limb.lower).y, at(limb.end).y + 0.1);
  }
  for (const auto& [foot, toes] :
       {std::pair{B::kLeftFoot, B::kLeftToes}, std::pair{B::kRightFoot, B::kRightToes}}) {
    if (!body.find(toes)) continue;
    EXPECT_GT(at(toes).z, at(foot).z + 0.01);
  }
}

TEST_P(EveryFile, IsMappedAndStands) {
  const FileCase& c = GetParam();
  if (!std::filesystem::exists(body_file(c.file))) GTEST_SKIP() << "it is missing";
  const auto body = read_body(body_file(c.file));
  ASSERT_TRUE(body) << body.error().message();
  EXPECT_EQ(body->bones.scheme, c.scheme);
  const Skeleton& skeleton = body->skeleton();
  ASSERT_TRUE(skeleton.find(B::kLeftLowerLeg));
  EXPECT_EQ(skeleton[*skeleton.find(B::kLeftLowerLeg)].name, c.left_knee);
  EXPECT_EQ(skeleton[*skeleton.find(B::kRightHand)].name, c.right_hand);
  EXPECT_GT(body->frame.stature_m, c.low_m);
  EXPECT_LT(body->frame.stature_m, c.high_m);
  expect_stands(skeleton);
  for (const auto& bone : body->bones.bones) {
    EXPECT_GE(bone ? bone->confidence : 1.0, 0.5);
  }
  const auto map = retarget::map_body(skeleton);
  EXPECT_TRUE(map) << map.error().message();
}

INSTANTIATE_TEST_SUITE_P(
    ReadBody,
    EveryFile,
    ::testing::Values(
        FileCase{"avatars/makehuman/adult_male_mixamo_unity.glb",
                 "Mixamo",
                 "mixamorig:LeftLeg",
                 "mixamorig:RightHand",
                 1.6,
                 2.0},
        FileCase{"avatars/makehuman/adult_female_game_engine.glb",
                 "Unreal",
                 "calf_l",
                 "hand_r",
                 1.5,
                 1.8},
        FileCase{"avatars/makehuman/giant_cmu_mb.glb",
                 "CMU, MotionBuilder",
                 "LeftLeg",
                 "RightHand",
                 2.4,
                 2.8},
        FileCase{"avatars/kaykit/manny_med_mod.gltf",
                 "VRM, Unity, Bandai, KayKit",
                 "lowerleg.l",
                 "wrist.r",
                 1.0,
                 2.3},
        FileCase{"avatars/kaykit/Med_MovementBasic.glb",
                 "VRM, Unity, Bandai, KayKit",
                 "lowerleg.l",
                 "wrist.r",
                 1.0,
                 2.3},
        FileCase{
            "avatars/khronos/cesium_man.gltf", "no names", "node_8", "node_15", 1.2, 1.6},
        FileCase{
            "avatars/vrm/cryptovoxels.vrm", "VRM", "Left knee", "Right wrist", 1.3, 1.6},
        FileCase{
            "avatars/threevrm/test.vrma", "VRM", "leftLowerLeg", "rightHand", 1.6, 1.9},
        FileCase{"mocap/bandai/dataset-1_walk_normal_001.bvh",
                 "VRM, Unity, Bandai, KayKit",
                 "LowerLeg_L",
                 "Hand_R",
                 1.4,
                 1.7},
        FileCase{"mocap/bandai/dataset-1_kick_normal_001.bvh",
                 "VRM, Unity, Bandai, KayKit",
                 "LowerLeg_L",
                 "Hand_R",
                 1.4,
                 1.7},
        FileCase{"mocap/bandai/dataset-1_dance-short_normal_001.bvh",
                 "VRM, Unity, Bandai, KayKit",
                 "LowerLeg_L",
                 "Hand_R",
                 1.4,
                 1.7},
        FileCase{"mocap/bvh_python/test_freebvh.bvh",
                 "Mixamo",
                 "mixamorig:LeftLeg",
                 "mixamorig:RightHand",
                 1.6,
                 1.9},
        FileCase{"mocap/bvh_python/test_mocapbank.bvh",
                 "joints (hip, knee, ankle)",
                 "LeftKnee",
                 "RightWrist",
                 1.6,
                 1.8},
        FileCase{"mocap/cmu_bvh_tmoco/02_01.bvh",
                 "CMU, MotionBuilder",
                 "LeftLeg",
                 "RightHand",
                 1.5,
                 1.8},
        FileCase{"mocap/cmu_bvh_tmoco/05_06.bvh",
                 "CMU, MotionBuilder",
                 "LeftLeg",
                 "RightHand",
                 1.5,
                 1.8},
        FileCase{
            "mocap/cmu_asfamc/02_01.amc", "CMU Acclaim", "ltibia", "rwrist", 1.5, 1.9},
        FileCase{"mocap/cmu_bvh_tmoco/rest.bvh",
                 "CMU, MotionBuilder",
                 "LeftLeg",
                 "RightHand",
                 1.5,
                 1.8}),
    [](const auto& case_info) {
      std::string text = case_info.param.file;
      std::erase_if(text, [](char c) { return std::isalnum(c) == 0; });
      return text;
    });

/// A body as another program would write it: names of its own scheme, Z up, inches.
Skeleton foreign_body() {
  Skeleton body = make_humanoid(average_proportions(1.75));
  for (Joint& joint : body.joints) {
    const B bone = *joint.bone;
    joint.name = "Knochen" + std::to_string(index(bone));
    joint.bone.reset();
  }
  return body;
}

std::string said(const std::filesystem::path& file) {
  const auto body = read_body(file);
  EXPECT_FALSE(body);
  return body ? "" : body.error().message();
}

TEST(ReadBody, ReadsTheAdjacentMapAndTheGivenOne) {
  const ScratchFolder folder;
  Motion motion;
  motion.rate.hz = 30.0;
  motion.skeleton = foreign_body();
  motion.poses = {rest_pose(motion.skeleton)};
  const auto file = folder / "man.bvh";
  ASSERT_TRUE(recordings::write_bvh(file, motion));
  ASSERT_TRUE(
      recordings::write_file(folder / "man.bones.toml", "[bones]\nleftToes = \"\"\n"));
  const auto body = read_body(file);
  ASSERT_TRUE(body) << body.error().message();
  EXPECT_EQ(body->bone_map, folder / "man.bones.toml");
  EXPECT_FALSE(body->skeleton().find(B::kLeftToes));
  EXPECT_TRUE(body->skeleton().find(B::kRightToes));
  ASSERT_TRUE(recordings::write_file(folder / "other.toml", "unit_m = 0.02\n"));
  const auto other = read_body({file, folder / "other.toml"});
  ASSERT_TRUE(other) << other.error().message();
  EXPECT_EQ(other->frame.scale, 2.0);
  EXPECT_TRUE(other->skeleton().find(B::kLeftToes));
  ASSERT_TRUE(
      recordings::write_file(folder / "man.bones.toml", "[bones]\nhip = \"a\"\n"));
  EXPECT_NE(said(file).find("man.bones.toml:2: there is no bone \"hip\""),
            std::string::npos);
}

TEST(ReadBody, NamesTheFileThatIsNoBody) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_file(
      folder / "boxes.gltf",
      R"({"asset":{"version":"2.0"},"nodes":[{"name":"Box","children":[1]},{"name":"Lid"}]})"));
  EXPECT_NE(said(folder / "boxes.gltf")
                .find("boxes.gltf: skeleton: no body was found among its 2 joints"),
            std::string::npos);
  ASSERT_TRUE(recordings::write_file(folder / "note.glb",
                                     "version https://git-lfs.github.com/spec/v1\n"));
  EXPECT_NE(said(folder / "note.glb").find("Git LFS"), std::string::npos);
  const Proportions p = recordings::mannequin_proportions({});
  ASSERT_TRUE(recordings::write_character(
      folder / "whole.glb", make_humanoid(p), recordings::make_mannequin_mesh(p)));
  const auto bytes = recordings::read_file(folder / "whole.glb");
  ASSERT_TRUE(bytes);
  ASSERT_TRUE(
      recordings::write_file(folder / "cut.glb", bytes->substr(0, bytes->size() / 2)));
  EXPECT_NE(said(folder / "cut.glb").find("cut short"), std::string::npos);
  ASSERT_TRUE(recordings::write_file(folder / "man.fbx", "Kaydara FBX Binary"));
  EXPECT_NE(said(folder / "man.fbx")
                .find("give a file of one of these kinds: .bvh, .amc, .npz, .glb, .gltf, "
                      ".vrm or .vrma"),
            std::string::npos);
}

/// Returns the joints of a retargeted file, in marey's frame.
std::vector<RigidTransform> placed(const std::filesystem::path& file, std::size_t frame) {
  const auto body = read_body(file);
  EXPECT_TRUE(body) << body.error().message();
  if (!body || body->raw.motion.poses.size() <= frame) return {};
  return world_from_joints(body->skeleton(), body->raw.motion.poses[frame]);
}

// CesiumMan faces +X in its file: the written file, read again, contains the same motion.
TEST(ReadBody, WritesAvatarsBackInTheirOwnFrame) {
  const auto avatar = body_file("avatars/khronos/cesium_man.gltf");
  const auto source = body_file("mocap/bvh_python/test_freebvh.bvh");
  if (!std::filesystem::exists(avatar) || !std::filesystem::exists(source)) {
    GTEST_SKIP() << "the files are missing";
  }
  const ScratchFolder folder;
  const auto motion = read_motion(source);
  ASSERT_TRUE(motion) << motion.error().message();
  const auto made = retarget_to_files(motion->motion, avatar, folder / "out");
  ASSERT_TRUE(made) << made.error().message();
  const Motion& truth = made->retargeted.motion;
  for (const std::size_t frame : {std::size_t{0}, truth.poses.size() - 1}) {
    const auto there = world_from_joints(truth.skeleton, truth.poses[frame]);
    const auto here = placed(folder / "out.glb", frame);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      EXPECT_LT(glm::distance(here[i].translation, there[i].translation), 1e-4);
    }
  }
}

}  // namespace
}  // namespace marey::app
