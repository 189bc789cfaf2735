// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/bone_map_file.h"

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/skeleton_picture.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using B = HumanBone;

Skeleton body() {
  Skeleton skeleton = make_humanoid(average_proportions(1.75));
  for (Joint& joint : skeleton.joints) joint.name = "the " + joint.name;
  return skeleton;
}

std::string map_refusal(const std::string& text, const Skeleton& skeleton = body()) {
  const auto map = parse_bone_map(text, "man.bones.toml", skeleton);
  EXPECT_FALSE(map);
  return map ? "" : map.error().message();
}

TEST(BoneMapFile, TakesItsPathFromTheBodyFile) {
  EXPECT_EQ(bone_map_path("a/man.v2.glb"), std::filesystem::path("a/man.v2.bones.toml"));
}

TEST(BoneMapFile, ComesBackAsItWasWritten) {
  BoneMap map;
  map.unit_m = 0.0254;
  map.up = glm::dvec3(0, 0, 1);
  map.front = glm::dvec3(0, -1, 0);
  map.bones[index(B::kHips)] = {true, JointIndex{0}};
  map.bones[index(B::kRightToes)] = {true, std::nullopt};
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_bone_map(folder / "a.bones.toml", map, body()));
  const auto read = read_bone_map(folder / "a.bones.toml", body());
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->unit_m, map.unit_m);
  EXPECT_EQ(read->up, map.up);
  EXPECT_EQ(read->front, map.front);
  for (const B bone : human_bones()) {
    EXPECT_EQ(read->bones[index(bone)].is_set, map.bones[index(bone)].is_set);
    EXPECT_EQ(read->bones[index(bone)].joint, map.bones[index(bone)].joint);
  }
}

TEST(BoneMapFile, ReadsAnyDirection) {
  const auto map = parse_bone_map("up = [0, 3, 0]\nfront = \"-X\"\n", "m", body());
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(map->front, glm::dvec3(-1, 0, 0));
}

TEST(BoneMapFile, NamesTheUnknownWordAndTheNearestOne) {
  EXPECT_EQ(map_refusal("[bones]\nhips = \"the hips\"\nleftFeet = \"the leftFoot\"\n"),
            "man.bones.toml:3: there is no bone \"leftFeet\". Next: perhaps you mean "
            "\"leftFoot\".");
  EXPECT_EQ(map_refusal("[bones]\nhips = \"the hipps\"\n"),
            "man.bones.toml:2: the body has no joint \"the hipps\". Next: perhaps you "
            "mean \"the hips\".");
  EXPECT_EQ(map_refusal("[bones]\nhips = \"the hips\"\nspine = \"the hips\"\n"),
            "man.bones.toml:3: \"the hips\" is hips already. Next: name another joint, "
            "or \"\" for a bone that the body does not have.");
  EXPECT_EQ(map_refusal("unit_m = 0\n").substr(0, 17), "man.bones.toml:1:");
  EXPECT_EQ(
      map_refusal("up = \"+W\"\n"),
      "man.bones.toml:1: \"up\" is not a direction. Next: give one of +X, +Y, +Z, -X, "
      "-Y, -Z, or three numbers.");
  EXPECT_EQ(map_refusal("up = \"+Z\"\nfront = \"-Z\"\n"),
            "man.bones.toml:2: \"front\" is not across \"up\". Next: give two directions "
            "that are at right angles.");
  EXPECT_NE(map_refusal("bone = 1\n").find("man.bones.toml:1: "), std::string::npos);
  EXPECT_NE(map_refusal("[bones\n").find("man.bones.toml:1"), std::string::npos);
}

TEST(BoneMapFile, DeclinesAndOmitsJointsThatShareAName) {
  Skeleton twins = body();
  twins.joints[5].name = twins.joints[4].name;
  EXPECT_EQ(map_refusal("[bones]\nneck = \"the neck\"\n", twins),
            "man.bones.toml:2: the body has 2 joints \"the neck\". Next: give them names "
            "of their own.");
  BoneMap map;
  map.bones[index(B::kNeck)] = {true, JointIndex{4}};
  map.bones[index(B::kHips)] = {true, JointIndex{0}};
  const std::string text = bone_map_text(map, twins);
  EXPECT_EQ(text.find("neck"), std::string::npos);
  EXPECT_NE(text.find("hips = \"the hips\""), std::string::npos);
}

TEST(SkeletonPicture, IsOfBothKindsAndNoOther) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_skeleton_picture(folder / "a.png", body(), "a"));
  ASSERT_TRUE(write_skeleton_picture(folder / "a.svg", body(), "a"));
  EXPECT_EQ(read_file(folder / "a.png")->substr(1, 3), "PNG");
  EXPECT_NE(read_file(folder / "a.svg")->find("<svg"), std::string::npos);
  const Status no = write_skeleton_picture(folder / "a.gif", body(), "a");
  ASSERT_FALSE(no);
  EXPECT_EQ(no.error().cause, "cannot draw a \".gif\" file");
  // A body of zero size also gives a picture.
  Skeleton dot;
  dot.joints.resize(1);
  EXPECT_TRUE(write_skeleton_picture(folder / "dot.png", dot, ""));
}

}  // namespace
}  // namespace marey::recordings
