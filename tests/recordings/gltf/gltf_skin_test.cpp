// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Skins of glTF files: the joints of the vertices.
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

std::string skin_refusal(const ScratchFolder& folder, const std::string& text) {
  EXPECT_TRUE(write_file(folder / "broken.gltf", text));
  const auto read = read_character(folder / "broken.gltf");
  return read ? "no refusal" : read.error().cause;
}

/// Returns a triangle on a skin with these joints, given by their nodes.
std::string skinned_triangle(const std::string& skin_joints) {
  // Three vertices at (0, 0, 0); their joints and weights are 0 too.
  const std::string zeros(64, 'A');
  return R"({"asset":{"version":"2.0"},
 "nodes":[{"name":"hips"},{"name":"body","mesh":0,"skin":0}],
 "skins":[{"joints":[)" +
         skin_joints + R"(]}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}],
 "buffers":[{"byteLength":48,"uri":"data:application/octet-stream;base64,)" +
         zeros + R"("}],
 "bufferViews":[{"buffer":0,"byteLength":48}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
  {"bufferView":0,"componentType":5121,"count":3,"type":"VEC4"},
  {"bufferView":0,"componentType":5126,"count":3,"type":"VEC4"}]})";
}

TEST(ReadCharacter, HangsVerticesWithoutWeightsOnTheFirstJoint) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.gltf", skinned_triangle("0")));
  const auto read = read_character(folder / "a.gltf");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(read->mesh);
  EXPECT_EQ(read->mesh->skin.at(0).weights[0], 1.0);
}

TEST(ReadCharacter, RefusesASkinWithoutJoints) {
  const ScratchFolder folder;
  EXPECT_EQ(skin_refusal(folder, skinned_triangle("")), "a skin has no joints");
}

// The bytes 80 80 80 3f are a weight of 1.004, and joints of -128 where bytes are signed.
TEST(ReadCharacter, RefusesVerticesOnJointsBelowZero) {
  const ScratchFolder folder;
  std::string text = skinned_triangle("0");
  text.replace(text.find(std::string(64, 'A')),
               64,
               "gICAP4CAgD+AgIA/gICAP4CAgD+AgIA/gICAP4CAgD+AgIA/gICAP4CAgD+AgIA/");
  text.replace(text.find("5121"), 4, "5120");
  EXPECT_EQ(skin_refusal(folder, text),
            "a vertex refers to joint -128, but its skin has 1");
}

}  // namespace
}  // namespace marey::recordings
