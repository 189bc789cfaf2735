// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey inspect` reads the files that marey writes, or names the program that reads
// them. `marey convert` reads the motions among these files. Hostile files end with one
// message.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/character_file.h"
#include "recordings/body/constraints_file.h"
#include "recordings/body/floor_file.h"
#include "recordings/edit/edit_recipe_file.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/npz.h"
#include "recordings/takes/live_take.h"
#include "recordings/takes/take_file.h"
#include "tests/app/labelled_session.h"
#include "tests/support/files/bombs.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kResults = marey::testing::sample_results() / "once";
const fs::path kSample = marey::testing::sample_session();

ProgramRun marey(const std::vector<std::string>& arguments) {
  return run_program(marey::testing::program(), arguments);
}

std::string kind_of(const fs::path& path) {
  const ProgramRun run = marey({"inspect", path.string(), "--json"});
  EXPECT_EQ(run.exit_code, 0) << path << ": " << run.err;
  const Json json = Json::parse(run.out, nullptr, false);
  EXPECT_TRUE(json.is_object()) << path;
  // Without --json, too.
  EXPECT_EQ(marey({"inspect", path.string()}).exit_code, 0) << path;
  return json.is_object() ? json.value("kind", "") : "";
}

void expect_one_message(const ProgramRun& run, const std::string& what) {
  EXPECT_EQ(run.exit_code, 3) << what << ": " << run.err.substr(0, 500);
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1)
      << what << ": " << run.err.substr(0, 500);
  EXPECT_LT(run.err.size(), 2000U) << what;
}

/// Every file below a folder is inspected, or declined as one of another program.
void expect_inspected(const fs::path& folder) {
  const std::set<std::string> for_others{".html", ".pdf", ".svg", ".png", ".mkv"};
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    if (!for_others.contains(entry.path().extension().string())) {
      EXPECT_NE(kind_of(entry.path()), "") << entry.path();
      continue;
    }
    const ProgramRun run = marey({"inspect", entry.path().string()});
    expect_one_message(run, entry.path().string());
    EXPECT_NE(run.err.find("open it with "), std::string::npos) << run.err;
  }
  EXPECT_GT(files, 0U);
}

void run_well(const std::vector<std::string>& arguments) {
  const ProgramRun run = marey(arguments);
  ASSERT_EQ(run.exit_code, 0) << arguments[0] << ": " << run.err;
}

Motion small_motion() {
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.7));
  motion.rate.hz = 30.0;
  motion.first_frame = 5;
  motion.poses.assign(4, rest_pose(motion.skeleton));
  motion.poses[1].root_in_world.x = 0.25;
  motion.poses[2].parent_from_joint[3] = glm::dquat(0.6, 0.0, 0.8, 0.0);
  return motion;
}

TEST(InspectResults, ReadsEveryFileThatProcessWrote) {
  expect_inspected(kResults);
  EXPECT_EQ(kind_of(kResults), "results");
  EXPECT_EQ(kind_of(kResults / "walk"), "trial");
  EXPECT_EQ(kind_of(kResults / "walk/motion.npz"), "npz");
}

TEST(InspectWritten, ReadsEveryFileThatFitAndRepairWrote) {
  const ScratchFolder folder;
  const fs::path in = write_static(folder, "static.c3d");
  const ProgramRun run = fit({in.string(), "--out", (folder / "fit").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  run_well({"repair", in.string(), "--out", (folder / "repair/out.c3d").string()});
  expect_inspected(folder / "fit");
  expect_inspected(folder / "repair");
  EXPECT_EQ(kind_of(folder / "fit"), "results");
}

TEST(InspectWritten, ReadsWhatPrintingPlanningAndBodiesWrite) {
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  run_well({"tags", "--ids", "1-4", "--size", "8cm", "--out", path("out/tags.pdf")});
  run_well({"board", "--out", path("out/board.pdf")});
  run_well({"mannequin", "--out", path("out/body.glb")});
  run_well({"inspect",
            path("out/body.glb"),
            "--write-map",
            "--picture",
            path("out/bones.svg")});
  std::ofstream(folder / "plan.toml")
      << "format = 1\ntag_size_m = 0.08\n[volume]\nleast_m = [-1, -1]\n"
         "greatest_m = [1, 1]\nstep_m = 1.0\n"
         "[[camera]]\nname = \"a\"\nplace_m = [-1.2, 1.4, 3.0]\nlooks_at_m = [0, 0.9, "
         "0]\n"
         "width_px = 1280\nheight_px = 720\nfield_of_view_deg = 70\n"
         "[[camera]]\nname = \"b\"\nplace_m = [1.2, 1.4, 3.0]\nlooks_at_m = [0, 0.9, 0]\n"
         "width_px = 1280\nheight_px = 720\nfield_of_view_deg = 70\n";
  run_well({"plan", path("plan.toml"), "--out", path("out/plan")});
  EXPECT_EQ(kind_of(folder / "plan.toml"), "plan");
  EXPECT_EQ(kind_of(folder / "out/plan"), "results");
  // A bone map requires its body. The message explains how to give both.
  const fs::path map = folder / "out/body.bones.toml";
  if (fs::exists(map)) {
    const ProgramRun run = marey({"inspect", map.string()});
    expect_one_message(run, "bone map");
    EXPECT_NE(run.err.find("--bones"), std::string::npos) << run.err;
    fs::remove(map);
  }
  expect_inspected(folder / "out");
}

TEST(InspectWritten, ReadsMotionsTablesAndSettings) {
  const ScratchFolder folder;
  const fs::path npz = folder / "motion.npz";
  const Motion motion = small_motion();
  ASSERT_TRUE(recordings::write_npz(npz, motion));
  EXPECT_EQ(kind_of(npz), "npz");
  for (const char* name : {"a.bvh", "a.vrma", "a.csv", "a.mot"}) {
    run_well({"convert", npz.string(), (folder / name).string()});
    EXPECT_NE(kind_of(folder / name), "") << name;
  }
  EXPECT_EQ(kind_of(folder / "a.csv"), "places");
  EXPECT_EQ(kind_of(folder / "a.mot"), "joint angles");
  ASSERT_TRUE(recordings::write_constraints(folder / "c.xml", {}));
  EXPECT_EQ(kind_of(folder / "c.xml"), "constraints");
  CharacterSpec spec;
  spec.name = "anybody";
  ASSERT_TRUE(recordings::write_character_spec(folder / "character.toml", spec));
  EXPECT_EQ(kind_of(folder / "character.toml"), "character file");
  ASSERT_TRUE(recordings::write_file(folder / "floor.toml", recordings::floor_text({})));
  EXPECT_EQ(kind_of(folder / "floor.toml"), "floor");
  EditRecipe recipe;
  recipe.sources.push_back({"", "a.bvh", "", 0});
  recipe.ops.push_back({MirrorOp{}, 1, false, {}, 0.0, {}, "", 0});
  ASSERT_TRUE(recordings::write_edit_recipe(folder / "a.edit.toml", recipe));
  EXPECT_EQ(kind_of(folder / "a.edit.toml"), "edit recipe");
}

TEST(InspectWritten, ReadsTakes) {
  const ScratchFolder folder;
  recordings::Take take;
  take.trial = "walk";
  take.started = "2026-11-21T11:56:29Z";
  take.cameras.push_back({"cam0", "cam0.mkv", 640, 480, {30.0}, "/dev/video0", "", {}});
  fs::create_directories(folder / "walk");
  fs::create_directories(folder / "live");
  auto writer = recordings::TakeWriter::create(folder / "walk/take.sqlite", take);
  ASSERT_TRUE(writer);
  writer->add(0, {Timestamp{5}, false, 0, 0, false});
  ASSERT_TRUE(writer->finish());
  auto live = recordings::LiveTakeWriter::create(
      folder / "live/live.sqlite",
      {"garden", "2026-11-22T10:00:00Z", {30.0}, {"left"}, "{}"});
  ASSERT_TRUE(live);
  ASSERT_TRUE(live->add({{1, Timestamp{5}, {}}, "", {}}));
  ASSERT_TRUE(live->finish());
  EXPECT_EQ(kind_of(folder / "walk/take.sqlite"), "take");
  EXPECT_EQ(kind_of(folder / "walk"), "take");
  EXPECT_EQ(kind_of(folder / "live/live.sqlite"), "live take");
  EXPECT_EQ(kind_of(folder / "live"), "live take");
}

TEST(InspectWritten, DeclinesAnEmptyFolder) {
  const ScratchFolder folder;
  const ProgramRun run = marey({"inspect", folder.path().string()});
  expect_one_message(run, "folder");
  EXPECT_NE(run.err.find("holds no session.toml, no results and no take"),
            std::string::npos)
      << run.err;
}

TEST(ConvertWritten, TakesAnNpzBackToTheMotionItWas) {
  const ScratchFolder folder;
  const Motion motion = small_motion();
  ASSERT_TRUE(recordings::write_npz(folder / "motion.npz", motion));
  run_well({"convert", (folder / "motion.npz").string(), (folder / "b.bvh").string()});
  const auto read = recordings::read_bvh(folder / "b.bvh");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->motion.poses.size(), motion.poses.size());
  EXPECT_NEAR(read->motion.rate.hz, 30.0, 1e-6);
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const auto truth = world_from_joints(motion.skeleton, motion.poses[f]);
    const auto found = world_from_joints(read->motion.skeleton, read->motion.poses[f]);
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const auto at = read->motion.skeleton.find(motion.skeleton.joints[j].name);
      ASSERT_TRUE(at);
      EXPECT_LT(glm::distance(found[index(*at)].translation, truth[j].translation),
                1e-5 /* m */);
    }
  }
}

TEST(ConvertWritten, SuggestsAnAlternativeInTheError) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_npz(folder / "motion.npz", small_motion()));
  run_well({"convert", (folder / "motion.npz").string(), (folder / "a.mot").string()});
  struct Case {
    fs::path in;
    const char* advice;
  };
  std::ofstream(folder / "report.json") << "{}";
  std::ofstream(folder / "take.sqlite") << "";
  for (const auto& [in, advice] : {Case{folder / "a.mot", "convert the motion.npz"},
                                   Case{folder.path(), "TRIAL/motion.npz"},
                                   Case{folder / "report.json", "convert the motion.npz"},
                                   Case{folder / "take.sqlite", "marey process"}}) {
    const ProgramRun run = marey({"convert", in.string(), (folder / "x.bvh").string()});
    expect_one_message(run, in.string());
    EXPECT_NE(run.err.find(advice), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "x.bvh"));
  }
}

TEST(InspectBody, WithABrokenBoneMapIsDeclined) {
  const ScratchFolder folder;
  const std::string body = (folder / "body.glb").string();
  run_well({"mannequin", "--out", body});
  for (const char* text : {"[bones]\nhips = \"nowhere\"\n",
                           "[bones\n",
                           "[bones]\nleftUpperLeg = \"head\"\n"}) {
    std::ofstream(folder / "map.toml") << text;
    const ProgramRun run =
        marey({"inspect", body, "--bones", (folder / "map.toml").string()});
    expect_one_message(run, text);
    EXPECT_EQ(run.out, "");
  }
  const ProgramRun missing =
      marey({"inspect", body, "--bones", (folder / "none.toml").string()});
  expect_one_message(missing, "no map");
}

TEST(InspectBombs, EndWithOneMessage) {
  const ScratchFolder folder;
  std::vector<Bomb> all = gltf_bombs();
  for (const auto& make :
       {skeleton_bombs, toml_bombs, tree_bombs, table_bombs, npz_bombs, json_bombs}) {
    for (Bomb& bomb : make()) all.push_back(std::move(bomb));
  }
  for (const Bomb& bomb : all) {
    const fs::path file = folder / bomb.name;
    ASSERT_TRUE(recordings::write_file(file, bomb.bytes));
    const ProgramRun run = marey({"inspect", file.string(), "--json"});
    if (bomb.may_be_read && run.exit_code == 0) {
      EXPECT_LT(run.out.size(), 100U << 20U) << bomb.name;
    } else {
      expect_one_message(run, bomb.name);
    }
    fs::remove(file);
  }
}

// As ASF chains come in: with their motion, to be converted.
TEST(ConvertBombs, EndWithOneMessageForAcclaim) {
  const ScratchFolder folder;
  for (const Bomb& bomb : skeleton_bombs()) {
    if (!bomb.name.ends_with(".asf") || bomb.may_be_read) continue;
    ASSERT_TRUE(recordings::write_file(folder / "a.asf", bomb.bytes));
    ASSERT_TRUE(recordings::write_file(
        folder / "a.amc", ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n"));
    expect_one_message(
        marey({"convert", (folder / "a.amc").string(), (folder / "a.bvh").string()}),
        bomb.name);
    EXPECT_FALSE(fs::exists(folder / "a.bvh"));
  }
}

}  // namespace
}  // namespace marey::testing
