// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/stage_results.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/stage/figures/measure_figures.h"
#include "app/stage/stage_commands.h"
#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf.h"
#include "tests/app/stage/made_stage.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app::testing {
namespace {

namespace fs = std::filesystem;
using marey::testing::ScratchFolder;

const std::string kPair =
    "[[group]]\nid = \"pair\"\ncount = 2\nstature_m = [1.5, 1.9]\n"
    "[[at]]\ntime_s = 0.5\nbody = \"pair\"\ndo = \"play\"\nclip = \"wave\"\n"
    "[[measure]]\nkind = \"feet_slide\"\nbody = \"pair\"\nmax_mm = 0.1\n";

/// A played scene, with the data that its result borrows.
struct MadeResult {
  explicit MadeResult(const std::string& text)
      : run(played(made_stage_input(text))), cast(*read_stage_cast(run.scene())) {}
  [[nodiscard]] StageResult result() const {
    return {run.record(), cast, measure_figures(run.record()), run.problems()};
  }
  SceneRun run;
  StageCast cast;
};

std::size_t entries_in(const fs::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder)) ++count;
  return count;
}

TEST(StageResults, WritesAllBodiesAndTheFigures) {
  const ScratchFolder scratch;
  const MadeResult made(kPair);
  ASSERT_TRUE(write_stage(made.result(), scratch / "out"));
  const auto glb = recordings::read_character(scratch / "out" / "made.glb");
  ASSERT_TRUE(glb);
  ASSERT_TRUE(glb->motion);
  const auto json = nlohmann::ordered_json::parse(
      *recordings::read_file(scratch / "out" / "stage.json"));
  EXPECT_EQ(json["bodies"].size(), 2U);
  ASSERT_EQ(json["figures"].size(), 1U);
  EXPECT_TRUE(json["figures"][0]["passed"].get<bool>());
  EXPECT_EQ(entries_in(scratch / "out"), 2U);
  EXPECT_EQ(entries_in(scratch.path()), 1U);
}

TEST(StageResults, ReplacesTheResultsOfASceneAndNoOtherFolder) {
  const ScratchFolder scratch;
  const MadeResult made(kPair);
  ASSERT_TRUE(write_stage(made.result(), scratch / "out"));
  EXPECT_TRUE(write_stage(made.result(), scratch / "out"));
  ASSERT_TRUE(recordings::write_file(scratch / "mine" / "notes.txt", "kept"));
  const auto refused = write_stage(made.result(), scratch / "mine");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().where.find("mine"), std::string::npos);
  EXPECT_EQ(*recordings::read_file(scratch / "mine" / "notes.txt"), "kept");
  EXPECT_EQ(entries_in(scratch.path()), 2U);
}

TEST(StageResults, FindsFiguresThatDoNotMeetTheirBounds) {
  const MadeResult made(
      "[[body]]\nid = \"ann\"\n"
      "[[target]]\nid = \"far\"\npath = \"fixed\"\nposition_m = [5.0, 1.0, 5.0]\n"
      "[[measure]]\nkind = \"clearance\"\nbody = \"ann\"\nsegment = \"leftHand\"\n"
      "target = \"far\"\nmax_mm = 100.0\n");
  const auto findings = assess_stage(made.result());
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].severity, Severity::kPoor);
  EXPECT_EQ(findings[0].id, "clearance");
  EXPECT_EQ(findings[0].code, Errc::kQuality);
}

TEST(StageResults, NamesTheBaseThatIsMissing) {
  const ScratchFolder scratch;
  ASSERT_TRUE(recordings::write_file(scratch / "scene.toml",
                                     "format = 1\nname = \"x\"\nduration_s = 1.0\n"
                                     "base = \"lost.marey\"\n[[body]]\nid = \"ann\"\n"));
  StageArguments args;
  args.scene = scratch / "scene.toml";
  const auto opened = open_scene(args);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message().find("lost.marey"), std::string::npos);
}

}  // namespace
}  // namespace marey::app::testing
