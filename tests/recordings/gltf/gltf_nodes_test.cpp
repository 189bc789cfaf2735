// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Nodes of other programs' files: scaled, mirrored, nameless; and bodies that were
// rotated and scaled after reading.
#include <cstdint>
#include <cstring>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// Returns three nodes in a row; `middle` is inserted into the second node's braces.
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

std::string node_refusal(const ScratchFolder& folder, const std::string& text) {
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
  EXPECT_EQ(node_refusal(folder, three_nodes(R"(,"scale":[-1,1,1])")), mirrored);
  EXPECT_EQ(node_refusal(folder, three_nodes(R"(,"scale":[0,1,1])")), mirrored);
  EXPECT_EQ(
      node_refusal(folder,
                   three_nodes(R"(,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1])")),
      mirrored);
  EXPECT_EQ(node_refusal(folder, three_nodes(R"(,"scale":[1,1.5,1])")),
            "the node \"Hips\" of its skeleton is not scaled alike in all directions");
}

TEST(GltfNodes, NamesTheTreesOfTwoBodies) {
  const ScratchFolder folder;
  EXPECT_EQ(node_refusal(folder,
                         R"({"asset":{"version":"2.0"},
 "nodes":[{"name":"Ann","children":[1]},{"name":"hips"},
          {"name":"Bob","children":[3]},{"name":"hips","translation":[1,0,0]}]})"),
            "the file holds two bodies: there is a joint \"hips\" below the node "
            "\"Ann\" and one below \"Bob\"");
}

// Clothes and hair have armatures of their own.
TEST(GltfNodes, JoinsTheTreesOfOneBody) {
  const ScratchFolder folder;
  const auto character = read(folder, R"({"asset":{"version":"2.0"},
 "nodes":[{"name":"Dress","children":[1]},{"name":"hips","translation":[0,1,0]},
          {"name":"Body","translation":[0,1,0],"children":[3]},
          {"name":"hips","children":[4]},{"name":"spine","translation":[0,0.2,0]}]})");
  ASSERT_TRUE(character) << character.error().message();
  const auto& joints = character->skeleton.joints;
  ASSERT_EQ(joints.size(), 3U);
  EXPECT_EQ(character->node_of_joint, (std::vector<int>{3, 4, 1}));
  EXPECT_EQ(joints[2].parent, JointIndex{0});
  EXPECT_EQ(joints[0].parent_from_joint.translation, glm::dvec3(0, 1, 0));
  EXPECT_EQ(joints[2].parent_from_joint.translation, glm::dvec3(0, 0, 0));
  EXPECT_EQ(joints[0].bone, HumanBone::kHips);
  EXPECT_FALSE(joints[2].bone);
}

/// A mesh-less file that requires an extension.
std::string required(const std::string& extension) {
  return R"({"asset":{"version":"2.0"},"extensionsUsed":[")" + extension +
         R"("],"extensionsRequired":[")" + extension +
         R"("],"nodes":[{"name":"hips","children":[1]},{"name":"spine"}]})";
}

TEST(GltfNodes, NamesTheExtensionThatItDoesNotRead) {
  const ScratchFolder folder;
  for (const char* extension : {"KHR_draco_mesh_compression",
                                "EXT_meshopt_compression",
                                "KHR_meshopt_compression",
                                "EXT_made_up"}) {
    const auto character = read(folder, required(extension));
    ASSERT_FALSE(character) << extension;
    EXPECT_NE(character.error().cause.find(extension), std::string::npos);
    EXPECT_NE(character.error().next.find("export it without"), std::string::npos);
  }
  EXPECT_TRUE(read(folder, required("KHR_texture_transform")));
}

/// A foot whose parent is the root in its file, and the shin in the body.
TEST(GltfNodes, WritesABodyThatHangsOtherwiseThanItsFile) {
  const ScratchFolder folder;
  const Proportions proportions = mannequin_proportions({});
  Skeleton own = make_humanoid(proportions);
  const auto rest = world_from_joints(own, rest_pose(own));
  const JointIndex foot = *own.find(HumanBone::kLeftFoot);
  Skeleton detached = own;
  detached.joints[index(foot)].parent = JointIndex{0};
  detached.joints[index(foot)].parent_from_joint = inverse(rest[0]) * rest[index(foot)];
  ASSERT_TRUE(write_character(
      folder / "own.glb", detached, make_mannequin_mesh(proportions), nullptr));
  ChangedFrame changed;
  changed.new_from_read = glm::angleAxis(3.0, glm::dvec3(0, 1, 0));
  changed.scale = 2.0;
  for (std::size_t i = 0; i < own.joints.size(); ++i) {
    changed.read_joint.emplace_back(JointIndex{static_cast<int>(i)});
    own.joints[i].parent_from_joint.translation *= changed.scale;
  }
  Motion motion{own, FrameRate{30.0}, 0, {}};
  Pose pose = rest_pose(own);
  pose.root_in_world = {0.3, 2.1, -0.2};
  for (std::size_t i = 0; i < own.joints.size(); ++i) {
    pose.parent_from_joint[i] =
        glm::angleAxis(0.1 * static_cast<double>(i % 7), glm::dvec3(1, 0, 0));
  }
  pose.parent_from_joint[0] = changed.new_from_read * pose.parent_from_joint[0];
  motion.poses.assign(2, pose);
  for (const bool turns : {false, true}) {
    changed.turns_scene = turns;
    const Status ok = write_retargeted(
        folder / "own.glb", folder / "out.glb", motion, "motion", changed);
    ASSERT_TRUE(ok) << ok.error().message();
    const auto back = read_character(folder / "out.glb");
    ASSERT_TRUE(back && back->motion);
    const auto a = world_from_joints(own, pose);
    const auto b = world_from_joints(back->skeleton, back->motion->poses[1]);
    const glm::dquat here =
        turns ? glm::dquat(1, 0, 0, 0) : glm::conjugate(changed.new_from_read);
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (i == index(foot) || i == index(*own.find(HumanBone::kLeftToes))) continue;
      EXPECT_LT(glm::distance(b[i].translation, here * (a[i].translation / 2.0)), 5e-6);
    }
    // A Pose cannot represent the movement of the foot relative to the root; the foot's
    // position is known by its rest length only.
    const glm::dvec3 foot_in_root = inverse(a[0]) * a[index(foot)].translation / 2.0;
    const glm::dvec3 at_rest = detached.joints[index(foot)].parent_from_joint.translation;
    EXPECT_NEAR(back->ignored_translation_m, glm::distance(foot_in_root, at_rest), 5e-6);
  }
}

// Nodes in the pose of an animation's frame; the skin has the bind pose.
TEST(GltfNodes, ReadsThePoseInWhichTheSkinWasBound) {
  const ScratchFolder folder;
  const Proportions proportions = mannequin_proportions({});
  const Skeleton bound = make_humanoid(proportions);
  ASSERT_TRUE(write_character(
      folder / "bound.glb", bound, make_mannequin_mesh(proportions), nullptr));
  const auto same = read_character(folder / "bound.glb");
  ASSERT_TRUE(same);
  EXPECT_FALSE(same->bound);
  EXPECT_TRUE(same->carries_skin[index(*bound.find(HumanBone::kLeftUpperLeg))]);
  // Rotates the left thigh's node in the file's text, without changing its length.
  std::string bytes = *read_file(folder / "bound.glb");
  const std::string node = R"({"name":"leftUpperLeg","translation":)";
  const auto at = bytes.find(node);
  ASSERT_NE(at, std::string::npos);
  const auto spare = bytes.find(R"("generator":"marey")");
  ASSERT_NE(spare, std::string::npos);
  const std::string turn = R"("rotation":[0.5,0,0,0.8660254],)";
  // The JSON chunk grows by the inserted text, padded with blanks.
  std::string json_length = bytes.substr(12, 4);
  std::uint32_t length = 0;
  std::memcpy(&length, json_length.data(), 4);
  std::string insert = turn;
  while (insert.size() % 4 != 0) insert += ' ';
  length += static_cast<std::uint32_t>(insert.size());
  std::memcpy(bytes.data() + 12, &length, 4);
  bytes.insert(at + 1, insert);
  const auto whole = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(bytes.data() + 8, &whole, 4);
  ASSERT_TRUE(write_file(folder / "posed.glb", bytes));
  const auto posed = read_character(folder / "posed.glb");
  ASSERT_TRUE(posed) << posed.error().message();
  ASSERT_TRUE(posed->bound);
  const auto a = world_from_joints(bound, rest_pose(bound));
  const auto b =
      world_from_joints(posed->bound->skeleton, rest_pose(posed->bound->skeleton));
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(glm::distance(a[i].translation, b[i].translation), 5e-6);
  }
  ASSERT_TRUE(posed->bound->mesh && same->mesh);
  EXPECT_LT(
      glm::distance(posed->bound->mesh->p_in_world[100], same->mesh->p_in_world[100]),
      5e-6);
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

// The file keeps its own frame and unit. The expected values are the file's own, read
// again.
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
  // Without `changed` it would lie on its back, a hundred times too small.
  const Status no = write_retargeted(folder / "own.glb", folder / "no.glb", seen);
  ASSERT_FALSE(no);
  EXPECT_EQ(no.error().cause,
            "the avatar and the body of the motion differ in size or direction");
}

}  // namespace
}  // namespace marey::recordings
