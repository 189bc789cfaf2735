// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey retarget`: inputs that it refuses, and results for the other inputs.
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "tests/app/retarget_scene.h"

namespace marey::testing {
namespace {

using Json = nlohmann::json;

/// Expects that the run ends with `exit_code`, reports `text` and leaves no output.
void refuses(const RetargetScene& scene,
             const std::vector<std::string>& options,
             int exit_code,
             const std::string& text) {
  const ProgramRun run = scene.retarget(options);
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
  EXPECT_FALSE(scene.has("o") || scene.has("o.bvh") || scene.has("o.glb"));
}

TEST(RetargetInput, ABadAvatarDoesNotStopTheOthers) {
  const RetargetScene scene;
  const ProgramRun run = scene.retarget(
      {"small.glb", "bad.glb", "none.vrm", "tall.glb", "--out", "all", "--json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("bad.glb: this is neither"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("none.vrm"), std::string::npos) << run.err;
  EXPECT_TRUE(scene.has("all/small.glb") && scene.has("all/tall.vrma"));
  EXPECT_FALSE(scene.has("all/bad.glb") || scene.has("all/bad.bvh"));
  const Json bodies = Json::parse(run.out).at("avatars");
  ASSERT_EQ(bodies.size(), 4U);
  EXPECT_TRUE(bodies[1].contains("error") && bodies[2].contains("error"));
  EXPECT_FALSE(bodies[0].contains("error") || bodies[3].contains("error"));
  refuses(scene, {"bad.glb", "none.vrm", "--out", "o"}, 3, "bad.glb: this is neither");
}

TEST(RetargetInput, IsNotOverwritten) {
  const RetargetScene scene;
  for (const auto& [options, role] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"small.glb", "--out", "small.glb"},
            "small.glb: the result would replace an avatar"},
           {{"small.glb", "--out", "."}, "small.glb: the result would replace an avatar"},
           {{"small.glb", "--out", "walk.bvh"},
            "walk.bvh: the result would replace the motion"},
           {{"small.glb", "--out", "o.bvh", "--constraints-out", "walk.bvh"},
            "would replace the motion"},
           {{"small.glb", "--out", "o.bvh", "--constraints-out", "o.bvh"},
            "two results would have this name"}}) {
    const std::string avatar = scene.bytes("small.glb");
    const std::string walk = scene.bytes("walk.bvh");
    refuses(scene, options, 3, role);
    EXPECT_EQ(scene.bytes("small.glb"), avatar);
    EXPECT_EQ(scene.bytes("walk.bvh"), walk);
  }
  // By another name, too.
  std::filesystem::create_symlink(scene / "walk.bvh", scene / "link.bvh");
  refuses(scene, {"small.glb", "--out", "link.bvh"}, 3, "would replace the motion");
}

TEST(RetargetInput, RefusesWhatCannotBeMeant) {
  const RetargetScene scene;
  std::filesystem::create_directory(scene / "other");
  std::filesystem::copy(scene / "tall.glb", scene / "other" / "small.glb");
  using Options = std::vector<std::string>;
  for (const auto& [options, exit_code, text] :
       std::vector<std::tuple<Options, int, std::string>>{
           {{"--out", "o"}, 2, "AVATAR is missing"},
           {{"small.glb"}, 2, "--out"},
           {{"small.glb", "--out", "o", "--formats", "glb,fbx"}, 2, "fbx"},
           {{"small.glb", "--out", "o", "--bvh-dialect", "max"}, 2, "max"},
           {{"small.glb", "--out", "o", "--root", "arms"}, 2, "arms"},
           {{"small.glb", "--out", "o", "--rate", "0"}, 2, "--rate"},
           {{"small.glb", "--out", "o.glb", "--bvh-dialect", "maya"}, 3, "a dialect"},
           {{"small.glb", "--out", "o.fbx"}, 3, "cannot write a \".fbx\" file"},
           {{"small.glb", "tall.glb", "--out", "o.glb"}, 3, "there are several avatars"},
           {{"small.glb", "--out", "o.glb", "--formats", "bvh"}, 3, "--out is one file"},
           {{"small.glb", "other/small.glb", "--out", "o"}, 3, "two results would"},
           {{"small.glb", "tall.glb", "--out", "o", "--bones", "b.toml"}, 3, "--bones"},
           {{"small.glb", "tall.glb", "--out", "o", "--constraints-out", "s.xml"},
            3,
            "footprints are written for one avatar"},
           {{"small.glb", "--out", "o", "--heights", "tall"}, 2, "tall"},
           {{"small.glb", "--out", "o", "--balance", "--no-ground"}, 3, "--balance"},
           {{"small.glb", "--out", "o", "--balance", "--live"}, 3, "leave out --live"},
           {{"small.glb", "--out", "o", "--path", "kept", "--live"}, 3, "--path kept"},
           {{"plain.bvh", "--out", "o.glb"}, 3, "plain.bvh: the body has no mesh"},
           {{"arms.bvh", "--out", "o.vrma"}, 3, "arms.bvh"},
           {{"plain.bvh", "--out", "o", "--formats", "glb"}, 3, "no mesh"}}) {
    refuses(scene, options, exit_code, text);
  }
}

TEST(RetargetInput, ReportsARequestedFormatThatABodyCannotHave) {
  const RetargetScene scene;
  const ProgramRun run = scene.retarget(
      {"arms.bvh", "plain.bvh", "--out", "all", "--formats", "bvh,vrma,glb"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("arms.bvh: no .vrma"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("plain.bvh: no .glb"), std::string::npos) << run.err;
  EXPECT_TRUE(scene.has("all/arms.bvh") && scene.has("all/plain.vrma"));
  EXPECT_FALSE(scene.has("all/arms.vrma"));
}

}  // namespace
}  // namespace marey::testing
