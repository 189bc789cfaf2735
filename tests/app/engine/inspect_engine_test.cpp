// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey inspect` of bases of clips and scenes.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/motion/npz.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {
namespace {

ProgramRun run_in(const ScratchFolder& folder, const std::vector<std::string>& words) {
  return run_program(program(), words, {.folder = folder.path(), .interrupt_at = {}});
}

TEST(InspectEngine, ListsTheClipsOfABase) {
  const ScratchFolder folder;
  ASSERT_TRUE(
      recordings::write_npz(folder / "walk.npz", synthetic_walk(180, 60.0).motion));
  ASSERT_EQ(run_in(folder, {"base", "build", "walk.npz", "--out", "a.marey"}).exit_code,
            0);
  const ProgramRun run = run_in(folder, {"inspect", "a.marey", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["kind"], "base");
  auto listed = nlohmann::json::parse(
      run_in(folder, {"base", "list", "a.marey", "--json"}).out, nullptr, false);
  ASSERT_TRUE(listed.is_object());
  listed["kind"] = "base";
  EXPECT_EQ(json, listed);
  const ProgramRun text = run_in(folder, {"inspect", "a.marey"});
  EXPECT_NE(text.out.find("walk: \"2.98 s, 60 Hz, "), std::string::npos) << text.out;
}

TEST(InspectEngine, RefusesADamagedBase) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "a.marey", "no base"));
  const ProgramRun run = run_in(folder, {"inspect", "a.marey"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("a.marey"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(". Next: "), std::string::npos) << run.err;
}

TEST(InspectEngine, ListsBodiesTargetsAndActionsOfAScene) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "scene.toml", formats_example("scene")));
  const ProgramRun run = run_in(folder, {"inspect", "scene.toml", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["kind"], "scene");
  EXPECT_EQ(
      json["bodies"],
      (std::vector<std::string>{"ann", "crowd.1", "crowd.2", "crowd.3", "crowd.4"}));
  ASSERT_EQ(json["targets"].size(), 1U);
  EXPECT_EQ(json["targets"][0]["id"], "cup");
  EXPECT_EQ(json["targets"][0]["path"], "lissajous");
  ASSERT_EQ(json["actions"].size(), 3U);
  EXPECT_EQ(json["actions"][0]["id"], "walk");
  EXPECT_EQ(json["actions"][0]["clip"], "walk");
  EXPECT_EQ(json["actions"][1]["do"], "reach");
  EXPECT_EQ(json["actions"][1]["after"], "walk");
  EXPECT_EQ(json["actions"][1]["target"], "cup");
  EXPECT_EQ(json["actions"][2]["body"], "crowd");
  const ProgramRun text = run_in(folder, {"inspect", "scene.toml"});
  EXPECT_NE(text.out.find("reach, clip"), std::string::npos) << text.out;
}

}  // namespace
}  // namespace marey::testing
