// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Nodes as other programs leave them: scaled, mirrored, nameless; and bodies that were
// turned and scaled since they were read.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "recordings/atomic_file.h"
#include "recordings/gltf.h"
#include "recordings/mannequin.h"
#include "tests/support/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// Three nodes in a row; `middle` is put into the second's braces.
std::string three_nodes(const std::string& middle) {
  return R"({"asset":{"version":"2.0"},"nodes":[
 {"name":"Armature","children":[1]},
 {"name":"Hips","children":[2])" +
         middle + R"(},
 {"translation":[0,1,0]}]})";
}

Result<Character> read(const ScratchFolder& folder, const std::string& text) {
  EXPECT_TRUE(write_file(folder / "a.gltf", text));
  return read_character(folder / "a.gltf");
}

std::string refusal(const ScratchFolder& folder, const std::string& text) {
  const auto character = read(folder, text);
  EXPECT_FALSE(character);
  return character ? "" : character.error().cause;
}

TEST(GltfNodes, GivesNamelessJointsTheirNumbers) {
  const ScratchFolder folder;
  const auto character = read(folder, three_nodes(""));
  ASSERT_TRUE(character) << character.error().message();
  EXPECT_EQ(character->skeleton.joints[2].name, "node_2");
}

TEST(GltfNodes, TakesScaleThatIsAlikeInAllDirections) {
  const ScratchFolder folder;
  const auto character = read(folder, three_nodes(R"(,"scale":[100,100,100])"));
  ASSERT_TRUE(character) << character.error().message();
  EXPECT_NEAR(character->skeleton.joints[2].parent_from_joint.translation.y, 100, 1e-9);
}

TEST(GltfNodes, DeclinesMirroredAndUnevenNodesByName) {
  const ScratchFolder folder;
  const std::string mirrored =
      "the node \"Hips\" of its skeleton has a negative scale or none: it is mirrored";
  EXPECT_EQ(refusal(folder, three_nodes(R"(,"scale":[-1,1,1])")), mirrored);
  EXPECT_EQ(refusal(folder, three_nodes(R"(,"scale":[0,1,1])")), mirrored);
  EXPECT_EQ(
      refusal(folder, three_nodes(R"(,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])")),
      mirrored);
  EXPECT_EQ(refusal(folder, three_nodes(R"(,"scale":[1,1.5,1])")),
            "the node \"Hips\" of its skeleton is not scaled alike in all directions");
}

TEST(GltfNodes, NamesTheTreesOfTwoBodies) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder,
                    R"({"asset":{"version":"2.0"},
 "nodes":[{"name":"Ann","children":[1]},{"name":"hips"},
          {"name":"Bob","children":[3]},{"name":"spine"}]})"),
            "the joints do not hang together under one root: some are below the node "
            "\"Ann\" and \"Bob\"");
}

TEST(GltfNodes, KnowsANoteOfGitLfs) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.glb",
                         "version https://git-lfs.github.com/spec/v1\noid sha256:00\n"));
  const auto character = read_character(folder / "a.glb");
  ASSERT_FALSE(character);
  EXPECT_EQ(character.error().cause,
            "this is a note of Git LFS in place of the file (git lfs pull fetches it)");
}

// The file keeps its own frame and unit. Truth: what the file itself says, read again.
TEST(GltfNodes, WritesATurnedAndScaledBodyInItsOwnFrame) {
  const ScratchFolder folder;
  const Proportions proportions = mannequin_proportions({});
  const Skeleton own = make_humanoid(proportions);
  ASSERT_TRUE(write_character(
      folder / "own.glb", own, make_mannequin_mesh(proportions), nullptr));
  const ChangedFrame changed{glm::angleAxis(1.5707963267948966, glm::dvec3(1, 0, 0)),
                             0.01};
  Motion motion;
  motion.rate.hz = 30.0;
  motion.skeleton = own;
  Pose pose = rest_pose(own);
  pose.root_in_world = {0.3, 1.1, -0.2};
  pose.parent_from_joint[0] = glm::angleAxis(0.4, glm::dvec3(0, 0, 1));
  pose.parent_from_joint[5] = glm::angleAxis(0.7, glm::dvec3(0, 1, 0));
  motion.poses.assign(2, pose);
  Motion seen = motion;
  for (Joint& joint : seen.skeleton.joints) {
    joint.parent_from_joint.translation *= changed.scale;
  }
  RigidTransform& root = seen.skeleton.joints[0].parent_from_joint;
  root = {changed.new_from_read * root.rotation,
          changed.new_from_read * root.translation};
  for (Pose& turned : seen.poses) {
    turned.root_in_world = changed.new_from_read * (changed.scale * turned.root_in_world);
    turned.parent_from_joint[0] = changed.new_from_read * turned.parent_from_joint[0];
  }
  const Status ok =
      write_retargeted(folder / "own.glb", folder / "out.glb", seen, "motion", changed);
  ASSERT_TRUE(ok) << ok.error().message();
  const auto back = read_character(folder / "out.glb");
  ASSERT_TRUE(back && back->motion);
  const auto a = world_from_joints(own, pose);
  const auto b = world_from_joints(back->skeleton, back->motion->poses[1]);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(glm::distance(a[i].translation, b[i].translation), 5e-6);
  }
  // Written without saying so it would lie on its back, a hundred times too small.
  const Status no = write_retargeted(folder / "own.glb", folder / "no.glb", seen);
  ASSERT_FALSE(no);
  EXPECT_EQ(no.error().cause,
            "the avatar and the body of the motion differ in size or direction");
}

}  // namespace
}  // namespace marey::recordings
