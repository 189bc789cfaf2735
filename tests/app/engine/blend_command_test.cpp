// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey blend` on made and captured motions.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/npz.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kWalkFrames = 240;  // 4 s at 60 Hz.

/// A folder with walk.npz, stroll.npz (the same at three quarters of the speed) and
/// seated.npz, whose feet are far from the floor.
class BlendFolder {
 public:
  BlendFolder() {
    Motion walk = synthetic_walk(kWalkFrames, 60.0).motion;
    EXPECT_TRUE(recordings::write_npz(folder_ / "walk.npz", walk));
    Motion stroll = walk;
    stroll.rate = {45.0};
    EXPECT_TRUE(recordings::write_npz(folder_ / "stroll.npz", stroll));
    Motion seated = walk;
    for (std::size_t t = 0; t < seated.poses.size(); ++t) {
      // Both feet move all the time.
      seated.poses[t].root_in_world.y += 0.5 + 0.02 * static_cast<double>(t);
    }
    EXPECT_TRUE(recordings::write_npz(folder_ / "seated.npz", seated));
  }

  [[nodiscard]] fs::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  [[nodiscard]] ProgramRun run(std::vector<std::string> words) const {
    words.insert(words.end(), {"--progress", "none"});
    return run_program(program(), words, {.folder = folder_.path(), .interrupt_at = {}});
  }
  [[nodiscard]] ProgramRun blend(const std::string& from,
                                 const std::string& to,
                                 const std::vector<std::string>& more) const {
    std::vector<std::string> words{"blend", from, to};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  [[nodiscard]] nlohmann::json figures(const std::string& from,
                                       const std::string& to,
                                       std::vector<std::string> more) const {
    more.emplace_back("--json");
    const ProgramRun done = blend(from, to, more);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return nlohmann::json::parse(done.out, nullptr, false);
  }
  [[nodiscard]] Motion motion(const std::string& name) const {
    auto read = recordings::read_npz(folder_ / name);
    EXPECT_TRUE(read) << read.error().message();
    return read ? read->motion : Motion{};
  }
  [[nodiscard]] std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

 private:
  ScratchFolder folder_;
};

void expect_blend_refusal(const ProgramRun& run, int exit_code, const std::string& part) {
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(part), std::string::npos) << part << "\n" << run.err;
  EXPECT_NE(run.err.find(". Next: "), std::string::npos) << run.err;
  EXPECT_TRUE(run.out.empty()) << run.out;
}

/// Largest distance of a joint between frames of two motions of one body. [m]
double farthest_m(const Motion& a, std::size_t i, const Motion& b, std::size_t k) {
  const auto first = world_from_joints(a.skeleton, a.poses.at(i));
  const auto second = world_from_joints(b.skeleton, b.poses.at(k));
  double farthest = 0.0;
  for (std::size_t j = 0; j < first.size(); ++j) {
    farthest =
        std::max(farthest, glm::distance(first[j].translation, second[j].translation));
  }
  return farthest;
}

// The same above the hips alone, relative to the hips.
double farthest_above_hips_m(const Motion& a,
                             std::size_t i,
                             const Motion& b,
                             std::size_t k) {
  const auto first = world_from_joints(a.skeleton, a.poses.at(i));
  const auto second = world_from_joints(b.skeleton, b.poses.at(k));
  double farthest = 0.0;
  for (std::size_t j = 0; j < first.size(); ++j) {
    const std::string& name = a.skeleton.joints[j].name;
    if (name.find("Leg") != std::string::npos || name.find("Foot") != std::string::npos ||
        name.find("Toe") != std::string::npos) {
      continue;
    }
    farthest = std::max(farthest,
                        glm::distance(first[j].translation - first[0].translation,
                                      second[j].translation - second[0].translation));
  }
  return farthest;
}

TEST(BlendCommand, PlaysTheFirstMotionUntilTheSwitch) {
  const BlendFolder folder;
  const auto json =
      folder.figures("walk.npz", "stroll.npz", {"--at", "1.5", "--out", "out.npz"});
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["switch_frame"], 89);
  const Motion out = folder.motion("out.npz");
  EXPECT_EQ(json["frames"], out.poses.size());
  EXPECT_EQ(out.rate.hz, 60.0);
  const Motion walk = folder.motion("walk.npz");
  // The first frame is one step after the start. Standing feet are held where they are;
  // those of the written walk slide by centimetres while they stand.
  for (const std::size_t frame : {0, 30, 60, 89}) {
    EXPECT_LT(farthest_above_hips_m(out, frame, walk, frame + 1), 1e-4) << frame;
    EXPECT_LT(farthest_m(out, frame, walk, frame + 1), 0.04) << frame;
  }
}

TEST(BlendCommand, ReportsTheTransitionThatWasAskedFor) {
  const BlendFolder folder;
  for (const char* kind : {"crossfade", "synchronised", "inertial", "cut"}) {
    const auto json = folder.figures(
        "walk.npz",
        "stroll.npz",
        {"--at", "1.5", "--out", "out.npz", "--kind", kind, "--seconds", "3"});
    ASSERT_TRUE(json.is_object());
    EXPECT_EQ(json["transition"], kind);
    EXPECT_EQ(json["frames"], 180);
    EXPECT_EQ(json["incompatible_s"].is_null(), std::string(kind) != "synchronised");
    EXPECT_GT(json["acceleration_ratio"].get<double>(), 0.0);
    EXPECT_TRUE(json["slide_cm_s"].is_object());
  }
}

TEST(BlendCommand, MatchesTheSupportsOfEqualWalks) {
  const BlendFolder folder;
  const auto json = folder.figures(
      "walk.npz", "stroll.npz", {"--at", "1.5", "--out", "out.npz", "--fade", "0.4"});
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["transition"], "synchronised");
  EXPECT_LT(json["incompatible_s"].get<double>(), 0.10);
  EXPECT_LT(json["slide_cm_s"]["mean"].get<double>(), 5.0);
  EXPECT_LT(json["acceleration_ratio"].get<double>(), 2.0);
  EXPECT_LT(json["hips_departure_cm"].get<double>(), 3.0);
}

TEST(BlendCommand, TakesClipsOfABase) {
  const BlendFolder folder;
  const ProgramRun built =
      folder.run({"base", "build", "walk.npz", "stroll.npz", "--out", "a.marey"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const auto json = folder.figures(
      "walk", "stroll", {"--base", "a.marey", "--at", "1", "--out", "out.glb"});
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["from"], "walk");
  EXPECT_EQ(json["to"], "stroll");
  EXPECT_TRUE(fs::exists(folder / "out.glb"));
  expect_blend_refusal(
      folder.blend("walk", "strol", {"--base", "a.marey", "--at", "1", "--out", "b.glb"}),
      3,
      "\"stroll\"");
  expect_blend_refusal(
      folder.blend(
          "walk", "stroll", {"--base", "walk.npz", "--at", "1", "--out", "b.glb"}),
      3,
      "no base of motion clips");
}

TEST(BlendCommand, PlaysOnAnotherBody) {
  const BlendFolder folder;
  ASSERT_EQ(folder.run({"mannequin", "--height", "1.2", "--out", "child.glb"}).exit_code,
            0);
  for (const char* out : {"out.glb", "out.bvh", "out.vrma", "out.npz", "out.csv"}) {
    const auto json = folder.figures(
        "walk.npz",
        "stroll.npz",
        {"--at", "1", "--on", "child.glb", "--seconds", "2", "--out", out});
    ASSERT_TRUE(json.is_object()) << out;
    EXPECT_EQ(json["body"], "child");
    EXPECT_TRUE(fs::exists(folder / out));
  }
  const Motion child = folder.motion("out.npz");
  EXPECT_LT(child.poses.front().root_in_world.y, 0.8);
  expect_blend_refusal(
      folder.blend("walk.npz",
                   "stroll.npz",
                   {"--at", "1", "--on", "child.glb", "--out", "child.glb"}),
      3,
      "would replace the body");
}

TEST(BlendCommand, GivesTheSameBytesEachTime) {
  const BlendFolder folder;
  for (const char* out : {"a.npz", "b.npz"}) {
    ASSERT_EQ(
        folder.blend("walk.npz", "stroll.npz", {"--at", "1.2", "--out", out}).exit_code,
        0);
  }
  EXPECT_EQ(*recordings::read_file(folder / "a.npz"),
            *recordings::read_file(folder / "b.npz"));
}

TEST(BlendCommand, SwitchesFromAMotionToItself) {
  const BlendFolder folder;
  const auto json =
      folder.figures("walk.npz", "walk.npz", {"--at", "2.2", "--out", "out.npz"});
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["from"], json["to"]);
}

TEST(BlendCommand, StatesThatAClipHasNoContacts) {
  const BlendFolder folder;
  const auto json =
      folder.figures("walk.npz", "seated.npz", {"--at", "1", "--out", "out.npz"});
  ASSERT_TRUE(json.is_object());
  EXPECT_TRUE(json["incompatible_s"].is_null());
  ASSERT_EQ(json["remarks"].size(), 1U);
  EXPECT_NE(json["remarks"][0].get<std::string>().find("\"seated\" has no contacts"),
            std::string::npos);
}

TEST(BlendCommand, RefusesWrongWordsAndTimesBeforeItWrites) {
  const BlendFolder folder;
  const std::set<std::string> before = folder.files();
  struct Refused {
    std::vector<std::string> more;
    int exit_code;
    std::string part;
  };
  for (const Refused& refused : std::vector<Refused>{
           {{"--out", "a.bvh"}, 2, "--at is missing"},
           {{"--at", "1"}, 2, "--out is missing"},
           {{"--at", "-1", "--out", "a.bvh"}, 2, "--at must be a number from 0"},
           {{"--at", "nan", "--out", "a.bvh"}, 2, "--at must be a number from 0"},
           {{"--at", "0", "--out", "a.bvh"}, 2, "before the first step"},
           {{"--at", "4.2", "--out", "a.bvh"}, 2, "after the end of \"walk\""},
           {{"--at", "1", "--out", "a.bvh", "--kind", "magic"}, 2, "--kind must be"},
           {{"--at", "1", "--out", "a.bvh", "--fade", "-1"}, 2, "--fade must be"},
           {{"--at", "1", "--out", "a.bvh", "--seconds", "0.5"}, 2, "before the switch"},
           {{"--at", "1", "--out", "a.txt"}, 3, "cannot write a \".txt\" file"},
           {{"--at", "1", "--out", "walk.npz"}, 3, "would replace the first motion"},
           {{"--at", "1", "--out", "./stroll.npz"}, 3, "would replace the second motion"},
           {{"--at", "1", "--out", "a.bvh", "--on", "gone.glb"}, 3, "does not exist"},
           {{"--at", "1", "--out", "a.bvh", "--base", "gone.marey"}, 3, "gone.marey"}}) {
    expect_blend_refusal(folder.blend("walk.npz", "stroll.npz", refused.more),
                         refused.exit_code,
                         refused.part);
  }
  expect_blend_refusal(
      folder.blend("gone.npz", "walk.npz", {"--at", "1", "--out", "a.bvh"}),
      3,
      "gone.npz: the file does not exist");
  expect_blend_refusal(
      folder.blend("walk.npz", ".", {"--at", "1", "--out", "a.bvh"}), 3, "is a folder");
  EXPECT_EQ(folder.files(), before);
}

TEST(BlendCommand, KeepsTheSourceOfARecipe) {
  const BlendFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "calm.edit.toml",
                                     "format = 1\nname = \"calm\"\n[source]\n"
                                     "path = \"walk.npz\"\n"));
  expect_blend_refusal(
      folder.blend("calm.edit.toml", "stroll.npz", {"--at", "1", "--out", "walk.npz"}),
      3,
      "would replace a source of the recipe");
  EXPECT_EQ(folder.blend("calm.edit.toml", "stroll.npz", {"--at", "1", "--out", "a.npz"})
                .exit_code,
            0);
}

TEST(BlendCommand, BlendsCapturedWalkAndRun) {
  const fs::path data = shared_data() / "mocap/cmu_asfamc";
  if (!fs::exists(data / "02_01.amc")) GTEST_SKIP() << "no " << data;
  const BlendFolder folder;
  const auto json = folder.figures((data / "02_01.amc").string(),
                                   (data / "02_03.amc").string(),
                                   {"--at", "1.2", "--out", "out.bvh"});
  ASSERT_TRUE(json.is_object());
  EXPECT_LE(json["acceleration_ratio"].get<double>(), 2.0);
  EXPECT_LE(json["slide_cm_s"]["mean"].get<double>(), 60.0);
  EXPECT_LE(json["hips_departure_cm"].get<double>(), 20.0);
}

}  // namespace
}  // namespace marey::testing
