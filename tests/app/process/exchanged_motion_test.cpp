// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey retarget` with a motion whose own left and right are exchanged.
#include <array>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "tests/app/retarget_scene.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos;) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

/// A captured walk whose file has no rest, with its sides' names exchanged.
std::string exchanged_walk() {
  const fs::path file =
      marey::testing::shared_data() / "mocap/bandai/dataset-1_walk_normal_001.bvh";
  if (!fs::exists(file)) return "";
  std::string text = *recordings::read_file(file);
  replace_all(text, "_L\n", "_?\n");
  replace_all(text, "_R\n", "_L\n");
  replace_all(text, "_?\n", "_R\n");
  return text;
}

constexpr std::array kBones{
    "Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes"};

TEST(ExchangedMotion, EndsWithCode4AndTheWayToCorrectIt) {
  const RetargetScene scene;
  const std::string text = exchanged_walk();
  if (text.empty()) GTEST_SKIP() << "the captured walk is not there";
  ASSERT_TRUE(recordings::write_file(scene / "wrong.bvh", text));
  const ProgramRun run =
      scene.marey({"retarget", "wrong.bvh", "small.glb", "--json", "--out", "o.glb"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  for (const char* word :
       {"wrong.bvh: ", "left and right are exchanged", "--write-map", "--motion-bones"}) {
    EXPECT_NE(run.err.find(word), std::string::npos) << word << " in " << run.err;
  }
  const auto problems = nlohmann::json::parse(run.out).at("problems");
  ASSERT_FALSE(problems.empty());
  EXPECT_NE(problems.back().get<std::string>().find("exchanged"), std::string::npos);
  // The way is one: a map with the names exchanged again.
  std::string map = "[bones]\n";
  for (const std::string bone : kBones) {
    map += "left" + bone + " = \"" + bone + "_R\"\n";
    map += "right" + bone + " = \"" + bone + "_L\"\n";
  }
  ASSERT_TRUE(recordings::write_file(scene / "map.toml", map));
  const ProgramRun again = scene.marey({"retarget",
                                        "wrong.bvh",
                                        "small.glb",
                                        "--motion-bones",
                                        "map.toml",
                                        "--out",
                                        "p.glb"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
}

}  // namespace
}  // namespace marey::testing
