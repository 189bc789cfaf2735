// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey base build`, `list` and `check` on made files.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/npz.h"
#include "recordings/moves/read_moves.h"
#include "tests/app/library/export/export_scene.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLoopRecipe =
    "format = 1\nname = \"walk.loop\"\n[source]\npath = \"walk.npz\"\n"
    "[[op]]\ndo = \"cyclify@1\"\n[[op]]\ndo = \"tag@1\"\ntext = \"calm\"\n"
    "[[op]]\ndo = \"tag@1\"\ntext = \"tag: slow\"\n";

/// A folder with walk.npz, run.bvh and the recipe of a loop of the walk.
class BaseFolder {
 public:
  BaseFolder() {
    const Motion walk = synthetic_walk(360, 120.0, 0.002, 0.0005).motion;
    EXPECT_TRUE(recordings::write_npz(folder_ / "walk.npz", walk));
    EXPECT_TRUE(
        recordings::write_bvh(folder_ / "run.bvh", synthetic_walk(90, 30.0).motion));
    EXPECT_TRUE(recordings::write_file(folder_ / "loop.edit.toml", kLoopRecipe));
  }

  [[nodiscard]] fs::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  [[nodiscard]] ProgramRun base(std::vector<std::string> words) const {
    words.insert(words.begin(), "base");
    if (!std::ranges::count(words, "--progress")) {
      words.insert(words.end(), {"--progress", "none"});
    }
    return run_program(program(), words, {.folder = folder_.path(), .interrupt_at = {}});
  }
  [[nodiscard]] MoveSet moves(const std::string& name) const {
    auto read = recordings::read_moves(folder_ / name);
    EXPECT_TRUE(read) << read.error().message();
    return read ? *std::move(read) : MoveSet{};
  }
  [[nodiscard]] std::string bytes(const std::string& name) const {
    const auto text = recordings::read_file(folder_ / name);
    return text ? *text : "missing";
  }

 private:
  ScratchFolder folder_;
};

void expect_base_refusal(const ProgramRun& run, int exit_code, const std::string& part) {
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_NE(run.err.find(part), std::string::npos) << part << "\n" << run.err;
  EXPECT_NE(run.err.find(". Next: "), std::string::npos) << run.err;
  EXPECT_TRUE(run.out.empty()) << run.out;
}

TEST(BaseCommand, MakesClipsOfMotionsAndRecipesOfAFolder) {
  const BaseFolder folder;
  const ProgramRun run = folder.base({"build", ".", "--out", "all.marey"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const MoveSet moves = folder.moves("all.marey");
  ASSERT_EQ(moves.clips.size(), 3U);
  EXPECT_EQ(moves.clips[0].name, "run");
  EXPECT_EQ(moves.clips[1].name, "walk");
  EXPECT_EQ(moves.clips[2].name, "walk.loop");
  EXPECT_EQ(moves.clips[1].frames.size(), 360U);
  EXPECT_EQ(moves.clips[1].rate_hz, 120.0F);
  EXPECT_FALSE(moves.clips[1].contacts[0].empty());
  EXPECT_TRUE(moves.clips[1].recipe_sha256.empty());
  EXPECT_EQ(moves.clips[1].document_sha256, recordings::sha256(folder.bytes("walk.npz")));
  EXPECT_EQ(run.out.rfind("name ", 0), 0U) << run.out;
  EXPECT_EQ(std::ranges::count(run.out, '\n'), 4) << run.out;
}

TEST(BaseCommand, MarksALoopAndItsTags) {
  const BaseFolder folder;
  const ProgramRun run =
      folder.base({"build", "loop.edit.toml", "--out", "a.marey", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const MoveSet moves = folder.moves("a.marey");
  ASSERT_EQ(moves.clips.size(), 1U);
  const MotionClip& clip = moves.clips[0];
  EXPECT_TRUE(clip.loops);
  // One cycle of the walk lasts 1.1 s; the first frame of the next one closes it.
  EXPECT_NEAR(clip.duration_s(), 1.1, 0.5 / 120.0);
  EXPECT_EQ(clip.frames.front(), clip.frames.back());
  EXPECT_EQ(clip.tags, (std::vector<std::string>{"calm", "slow", "tag: slow"}));
  EXPECT_EQ(clip.document_sha256, recordings::sha256(folder.bytes("walk.npz")));
  EXPECT_EQ(clip.recipe_sha256, recordings::sha256(kLoopRecipe));
  for (const Annotation& note : clip.notes) {
    EXPECT_LE(note.end_s, clip.duration_s());
  }
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << run.out;
  EXPECT_EQ(json["clips"][0]["loops"], true);
  EXPECT_EQ(json["clips"][0]["frames"], clip.frames.size());
}

TEST(BaseCommand, GivesTheSameBytesEachTimeAndReplacesItsFile) {
  const BaseFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "a.marey", "something else"));
  for (const char* out : {"a.marey", "b.marey"}) {
    ASSERT_EQ(folder.base({"build", "walk.npz", "run.bvh", "--out", out}).exit_code, 0);
  }
  EXPECT_EQ(folder.bytes("a.marey"), folder.bytes("b.marey"));
}

TEST(BaseCommand, ListsAndChecksItsFile) {
  const BaseFolder folder;
  const ProgramRun built = folder.base({"build", "walk.npz", "--out", "a.marey"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const ProgramRun list = folder.base({"list", "a.marey"});
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_EQ(list.out, built.out);
  const ProgramRun check = folder.base({"check", "a.marey", "--progress", "auto"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_NE(check.err.find("1 clips, no fault"), std::string::npos) << check.err;
  const auto json = nlohmann::json::parse(
      folder.base({"list", "a.marey", "--json"}).out, nullptr, false);
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["clips"][0]["name"], "walk");
  EXPECT_NEAR(json["clips"][0]["seconds"].get<double>(), 359.0 / 120.0, 1e-9);
  EXPECT_GT(json["clips"][0]["phases"].get<int>(), 3);
  // The walk goes 1.1 s per two steps at about a metre a second.
  EXPECT_NEAR(json["clips"][0]["speed_m_s"].get<double>(), 1.2, 0.4);
}

TEST(BaseCommand, RefusesADamagedFileWithItsPlace) {
  const BaseFolder folder;
  ASSERT_EQ(folder.base({"build", "walk.npz", "--out", "a.marey"}).exit_code, 0);
  std::string bytes = folder.bytes("a.marey");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  ASSERT_TRUE(recordings::write_file(folder / "flipped.marey", bytes));
  ASSERT_TRUE(recordings::write_file(folder / "short.marey", bytes.substr(0, 5000)));
  for (const char* command : {"list", "check"}) {
    expect_base_refusal(folder.base({command, "flipped.marey"}), 3, "differs from its");
    expect_base_refusal(folder.base({command, "short.marey"}), 3, "5000 bytes instead");
    expect_base_refusal(folder.base({command, "gone.marey"}), 3, "does not exist");
    expect_base_refusal(folder.base({command, "run.bvh"}), 3, "no base of motion clips");
  }
}

TEST(BaseCommand, RefusesWrongWordsAndInputsBeforeItWrites) {
  const BaseFolder folder;
  expect_base_refusal(folder.base({"build", "walk.npz"}), 2, "--out is");
  expect_base_refusal(
      folder.base({"build", "walk.npz", "--out", "a.bvh"}), 2, "no name of a base");
  expect_base_refusal(
      folder.base({"build", "gone.bvh", "--out", "a.marey"}), 3, "does not exist");
  expect_base_refusal(
      folder.base({"build", "walk.npz", "--loops", "wlak", "--out", "a.marey"}),
      2,
      "no clip has the name \"wlak\"");
  expect_base_refusal(
      folder.base({"build", "walk.npz", "--loops", "walk", "--out", "a.marey"}),
      3,
      "clip \"walk\"");
  expect_base_refusal(
      folder.base({"build", "walk.npz", "./walk.npz", "--out", "a.marey"}),
      3,
      "a second clip has the name \"walk\"");
  fs::create_directory(folder / "empty");
  expect_base_refusal(
      folder.base({"build", "empty", "--out", "a.marey"}), 3, "no motion and no recipe");
  expect_base_refusal(
      folder.base({"build", ".", "--query", "seconds>1", "--out", "a.marey"}),
      3,
      "library");
  EXPECT_EQ(folder.bytes("a.marey"), "missing");
}

TEST(BaseCommand, TakesClipsOfALibrary) {
  const BaseFolder folder;
  ExportScene scene;
  const std::string library = scene.library().string();
  const ProgramRun run = folder.base(
      {"build", library, "--query", "subject=anna or licence=MIT", "--out", "a.marey"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const MoveSet moves = folder.moves("a.marey");
  ASSERT_EQ(moves.clips.size(), 3U);
  EXPECT_EQ(moves.clips[0].name, "child");
  EXPECT_EQ(moves.clips[1].name, "walk.001");
  EXPECT_EQ(moves.clips[1].frames.size(), 60U);
  EXPECT_EQ(moves.clips[1].tags,
            (std::vector<std::string>{"a \"leftish\", step", "turn left"}));
  EXPECT_EQ(moves.clips[1].document_sha256, scene.records()[0].provenance.source_id);
  EXPECT_LT(moves.clips[0].leg_length_m, moves.clips[1].leg_length_m);
  expect_base_refusal(
      folder.base({"build", library, "--query", "seconds>99", "--out", "b.marey"}),
      3,
      "no clip of the library matches");
}

TEST(BaseCommand, TakesCapturedMotions) {
  const fs::path data = shared_data() / "mocap/cmu_asfamc";
  if (!fs::exists(data / "02_01.amc")) GTEST_SKIP() << "no " << data;
  const BaseFolder folder;
  const ProgramRun run = folder.base({"build",
                                      (data / "02_01.amc").string(),
                                      (data / "02_03.amc").string(),
                                      "--out",
                                      "a.marey"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const MoveSet moves = folder.moves("a.marey");
  ASSERT_EQ(moves.clips.size(), 2U);
  for (const MotionClip& clip : moves.clips) {
    EXPECT_FALSE(clip.contacts[0].empty() && clip.contacts[1].empty());
  }
}

}  // namespace
}  // namespace marey::testing
