// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Properties of a GLB's animation that players require.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/human/average_proportions.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "tests/recordings/wild_motion.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// The document of a GLB and its data.
struct Glb {
  nlohmann::json json;
  std::string data;

  explicit Glb(const std::string& bytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, sizeof size);
    json = nlohmann::json::parse(bytes.substr(20, size));
    data = bytes.substr(20 + size + 8);
  }

  [[nodiscard]] std::vector<float> floats(std::size_t accessor) const {
    const auto& view =
        json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()];
    std::vector<float> values(view["byteLength"].get<std::size_t>() / sizeof(float));
    std::memcpy(values.data(),
                data.data() + view["byteOffset"].get<std::size_t>(),
                values.size() * sizeof(float));
    return values;
  }
};

/// Neighbouring frames whose quaternions differ in sign, at a rate that is no whole
/// number.
Motion a_motion() {
  Motion motion = wild_motion(make_humanoid(average_proportions(1.75)), 40);
  motion.rate.hz = 29.97;
  for (std::size_t i = 0; i < motion.poses.size(); i += 2) {
    for (glm::dquat& q : motion.poses[i].parent_from_joint) q = -q;
  }
  return motion;
}

void expect_playable(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path);
  ASSERT_TRUE(bytes) << bytes.error().message();
  const Glb glb(*bytes);
  ASSERT_EQ(glb.json["animations"].size(), 1U);
  const auto& animation = glb.json["animations"][0];
  EXPECT_EQ(animation["name"], "jump");
  int moved = 0;
  for (const auto& channel : animation["channels"]) {
    const auto& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
    EXPECT_EQ(sampler["interpolation"], "LINEAR");
    const auto times = glb.floats(sampler["input"]);
    ASSERT_EQ(times.size(), 40U);
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_EQ(times[i], static_cast<float>(static_cast<double>(i) / 29.97));
    }
    const std::string what = channel["target"]["path"];
    EXPECT_NE(what, "scale");
    moved += what == "translation" ? 1 : 0;
    if (what != "rotation") continue;
    const auto keys = glb.floats(sampler["output"]);
    for (std::size_t i = 4; i < keys.size(); i += 4) {
      float dot = 0.0F;
      for (std::size_t k = 0; k < 4; ++k) dot += keys[i + k] * keys[i + k - 4];
      EXPECT_GE(dot, 0.0F);
    }
  }
  EXPECT_EQ(moved, 1);
}

TEST(GltfClip, IsNamedEvenUnscaledAndGoesTheShortWay) {
  const ScratchFolder folder;
  const Motion motion = a_motion();
  const auto mesh = make_mannequin_mesh(average_proportions(1.75));
  ASSERT_TRUE(write_character(folder / "a.glb", motion.skeleton, mesh, &motion, "jump"));
  expect_playable(folder / "a.glb");
  const auto read = read_character(folder / "a.glb");
  ASSERT_TRUE(read && read->motion);
  EXPECT_EQ(read->motion->rate.hz, 29.97);
}

TEST(GltfClip, IsSoOnAnAvatarToo) {
  const ScratchFolder folder;
  const Motion motion = a_motion();
  const auto mesh = make_mannequin_mesh(average_proportions(1.75));
  ASSERT_TRUE(write_character(folder / "body.glb", motion.skeleton, mesh));
  ASSERT_TRUE(write_retargeted(folder / "body.glb", folder / "a.glb", motion, "jump"));
  expect_playable(folder / "a.glb");
}

}  // namespace
}  // namespace marey::recordings
