// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey edit`: one recipe, many motions, differences, and refusals.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/edit/edit_batch.h"
#include "recordings/base/atomic_file.h"
#include "recordings/motion/npz.h"
#include "tests/app/edit/edit_folder.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kLoop =
    "[[op]]\ndo = \"cut@1\"\nfrom_s = 0.2\n"
    "[[op]]\ndo = \"filter@1\"\n"
    "[[op]]\ndo = \"plant@1\"\n"
    "[[op]]\ndo = \"cyclify@1\"\n"
    "[[op]]\ndo = \"tag@1\"\ntext = \"locomotion:walk\"\n";

TEST(EditCommand, GivesTheSourceToTheBitWithoutOperations) {
  const EditFolder folder;
  folder.write_recipe("");
  ASSERT_EQ(folder.run().exit_code, 0);
  const auto source = recordings::read_npz(folder / "walk.npz");
  const auto result = recordings::read_npz(folder / "out/a.npz");
  ASSERT_TRUE(source && result);
  ASSERT_EQ(result->motion.poses.size(), source->motion.poses.size());
  for (std::size_t t = 0; t < source->motion.poses.size(); ++t) {
    ASSERT_EQ(result->motion.poses[t].root_in_world,
              source->motion.poses[t].root_in_world);
    ASSERT_EQ(result->motion.poses[t].parent_from_joint,
              source->motion.poses[t].parent_from_joint);
  }
}

TEST(EditCommand, WritesTheSameBytesEachTime) {
  const EditFolder folder;
  folder.write_recipe(kLoop);
  const ProgramRun first = folder.run();
  ASSERT_EQ(first.exit_code, 0) << first.err;
  std::vector<std::string> before;
  const std::vector<std::string> names{
      "out/a.npz", "out/a.bvh", "out/a.glb", "out/a.annotations.json", "out/a.edit.json"};
  for (const std::string& name : names) before.push_back(folder.bytes(name));
  fs::remove_all(folder / "out");
  ASSERT_EQ(folder.run().exit_code, 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(folder.bytes(names[i]), before[i]) << names[i];
    EXPECT_NE(before[i], "missing") << names[i];
  }
}

TEST(EditCommand, RecordsTheOriginOfFrames) {
  const EditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"cut@1\"\nfrom_frame = 100\nto_frame = 150\n");
  const ProgramRun run = folder.run({"--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const Json& result = json.at("results").at(0);
  EXPECT_EQ(result.at("frames"), 51);
  EXPECT_EQ(result.at("lineage").at(0).at("source_frames"), Json({100.0, 150.0}));
  EXPECT_EQ(result.at("lineage").at(0).at("operations"), Json({0}));
}

TEST(EditCommand, RefusesASourceThatChanged) {
  const EditFolder folder;
  folder.write_recipe("");
  ASSERT_EQ(folder.run({"--pin"}).exit_code, 0);
  EXPECT_NE(folder.bytes("a.edit.toml").find("sha256"), std::string::npos);
  ASSERT_EQ(folder.run().exit_code, 0);
  ASSERT_TRUE(
      recordings::write_npz(folder / "walk.npz", synthetic_walk(300, 120.0).motion));
  const ProgramRun run = folder.run();
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("has another content than the recipe was made for"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(folder.run({"--accept-new-source"}).exit_code, 0);
}

TEST(EditCommand, NamesFileAndLineOfAnOperationThatFails) {
  const EditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"cut@1\"\nfrom_s = 2.0\nto_s = 1.0\n");
  const ProgramRun run = folder.run();
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("a.edit.toml:"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("the span ends before it starts"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder / "out/a.npz"));
}

TEST(EditCommand, FindsAMovedSourceInTheFolderOfTheRecipe) {
  const EditFolder folder;
  folder.write_recipe("", "path = \"gone/walk.npz\"");
  EXPECT_EQ(folder.run().exit_code, 0);
  folder.write_recipe("", "path = \"gone/run.npz\"");
  const ProgramRun run = folder.run();
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("does not exist"), std::string::npos) << run.err;
}

TEST(EditCommand, RefusesRecipesThatAreSourcesOfEachOther) {
  const EditFolder folder;
  folder.write_recipe("", "path = \"b.edit.toml\"");
  folder.write_recipe("", "path = \"a.edit.toml\"", "b.edit.toml");
  const ProgramRun run = folder.run();
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("is a source of itself"), std::string::npos) << run.err;
}

TEST(EditCommand, EndsWithFourAboveALimit) {
  const EditFolder folder;
  folder.write_recipe("[limits]\nslide_mm = 0.01\n");
  const ProgramRun run = folder.run();
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("the largest drift of a standing foot is"), std::string::npos)
      << run.err;
}

TEST(EditCommand, GoesOnAfterABrokenMotionOfMany) {
  const EditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"mirror@1\"\n");
  for (const std::string name : {"one", "three", "two"}) {
    fs::create_directories(folder / ("takes/" + name));
    fs::copy_file(folder / "walk.npz", folder / ("takes/" + name + "/motion.npz"));
  }
  ASSERT_TRUE(recordings::write_file(folder / "takes/two/motion.npz", "broken"));
  const ProgramRun run = folder.run({"--each", "takes/*/motion.npz"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_NE(run.err.find("takes/two/motion.npz"), std::string::npos) << run.err;
  EXPECT_TRUE(fs::exists(folder / "out/one.motion.npz"));
  EXPECT_TRUE(fs::exists(folder / "out/three.motion.npz"));
  const std::string table = folder.bytes("out/edit.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << table;
}

TEST(EditCommand, WritesNothingWithCheck) {
  const EditFolder folder;
  folder.write_recipe(kLoop);
  const ProgramRun run =
      folder.call({"--progress", "none", "edit", "a.edit.toml", "--check"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(EditCommand, WritesNothingWithCheckOfManyMotions) {
  const EditFolder folder;
  folder.write_recipe("[limits]\nslide_mm = 0.01\n[[op]]\ndo = \"mirror@1\"\n");
  const std::string before = folder.bytes("walk.npz");
  const ProgramRun run = folder.call(
      {"--progress", "none", "edit", "a.edit.toml", "--each", "*.npz", "--check"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_EQ(folder.bytes("walk.npz"), before);
  for (const char* name : {"edit.csv", "walk.edit.json", "walk.bvh"}) {
    EXPECT_FALSE(fs::exists(folder / name)) << name;
  }
}

TEST(EditCommand, AppliesTheFirstOperationsToManyMotions) {
  const EditFolder folder;
  folder.write_recipe(
      "[[op]]\ndo = \"cut@1\"\nto_frame = 99\n[[op]]\ndo = \"cut@1\"\nto_frame = 9\n");
  const ProgramRun run = folder.run({"--each", "*.npz", "--until", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(folder.bytes("out/edit.csv").find("\"walk\",\"walk.npz\",100,"),
            std::string::npos);
}

TEST(EditCommand, RefusesToOverwriteItsSources) {
  const EditFolder folder;
  const std::string mirror = "[[op]]\ndo = \"mirror@1\"\n";
  const std::string before = folder.bytes("walk.npz");
  ASSERT_TRUE(recordings::write_file(
      folder / "w.edit.toml",
      "format = 1\nname = \"walk\"\n[source]\npath = \"walk.npz\"\n" + mirror));
  folder.write_recipe(mirror, "path = \"w.edit.toml\"");
  ASSERT_TRUE(recordings::write_file(
      folder / "nested.edit.toml",
      "format = 1\nname = \"walk\"\n[source]\npath = \"w.edit.toml\"\n"));
  fs::create_directory(folder / "sub");
  const std::vector<std::vector<std::string>> runs{
      {"w.edit.toml", "--out", "."},
      {"w.edit.toml", "--out", "sub/.."},
      {"nested.edit.toml", "--out", "."},
      {"a.edit.toml", "--each", "*.npz", "--out", "."}};
  for (std::vector<std::string> arguments : runs) {
    arguments.insert(arguments.begin(), {"--progress", "none", "edit"});
    const ProgramRun run = folder.call(arguments);
    EXPECT_NE(run.exit_code, 0) << arguments[3];
    EXPECT_NE(run.err.find("would overwrite it"), std::string::npos) << run.err;
    EXPECT_EQ(folder.bytes("walk.npz"), before) << arguments[3];
    EXPECT_FALSE(fs::exists(folder / "walk.bvh")) << arguments[3];
    EXPECT_FALSE(fs::exists(folder / "walk.edit.json")) << arguments[3];
  }
  // Other formats do not overwrite it.
  const ProgramRun other =
      folder.call({"edit", "w.edit.toml", "--out", ".", "--format", "bvh"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
}

TEST(EditCommand, RefusesOptionsThatItWouldIgnore) {
  const EditFolder folder;
  folder.write_recipe("");
  const std::vector<std::vector<std::string>> runs{
      {"a.edit.toml", "--each", "*.npz", "--out", "out", "--json"},
      {"a.edit.toml", "--each", "*.npz", "--out", "out", "--pin"},
      {"walk.npz", "--new", "n.edit.toml", "--each", "*.npz"},
      {"walk.npz", "--new", "n.edit.toml", "--check"},
      {"walk.npz", "--new", "n.edit.toml", "--out", "out"},
      {"walk.npz", "--new", "n.txt"},
      {"walk.npz", "--page", "--no-open", "--seconds", "1", "--format", "c3d"}};
  for (std::vector<std::string> arguments : runs) {
    arguments.insert(arguments.begin(), {"--progress", "none", "edit"});
    const ProgramRun run = folder.call(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_FALSE(fs::exists(folder / "n.edit.toml"));
    EXPECT_FALSE(fs::exists(folder / "n.txt"));
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
}

TEST(EditCommand, NewRecipesNeedTheirFolderAndSource) {
  const EditFolder folder;
  const ProgramRun absent =
      folder.call({"edit", "none/walk.npz", "--new", "n.edit.toml"});
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_NE(absent.err.find("none/walk.npz: the file does not exist"), std::string::npos)
      << absent.err;
  const ProgramRun no_folder =
      folder.call({"edit", "walk.npz", "--new", "none/n.edit.toml"});
  EXPECT_EQ(no_folder.exit_code, 3);
  EXPECT_NE(no_folder.err.find("its folder does not exist"), std::string::npos)
      << no_folder.err;
}

TEST(EditCommand, NamesTheConstraintThatIsNotMet) {
  const EditFolder folder;
  folder.write_recipe(
      "[[op]]\ndo = \"constrain@1\"\nadapt = true\n[op.constraint]\ntype = "
      "\"Distance\"\nname = \"rail\"\nsegment = \"rightHand\"\nstart_s = 1\nstop_s = "
      "1.5\nposition_m = [0.0, 9.0, 0.0]\n");
  const ProgramRun run = folder.run();
  EXPECT_NE(run.err.find("operation 1 (constrain@1): constraint \"rail\": its error is"),
            std::string::npos)
      << run.err;
}

TEST(EditCommand, ShowsTheOperationsAndMillimetresThatDiffer) {
  const EditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"cut@1\"\nfrom_s = 0.5\n");
  folder.write_recipe(
      "[[op]]\ndo = \"cut@1\"\nfrom_s = 0.5\n"
      "[[op]]\ndo = \"place@1\"\nposition_xz_m = [1.0, 0.0]\n",
      "path = \"walk.npz\"",
      "b.edit.toml");
  const ProgramRun run =
      folder.call({"--progress", "none", "edit", "diff", "a.edit.toml", "b.edit.toml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("+ [[op]]"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("place@1"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("cut@1"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("largest difference: "), std::string::npos) << run.out;
}

TEST(EditCommand, NamesNoJointOfEqualResults) {
  const EditFolder folder;
  folder.write_recipe("");
  const ProgramRun run =
      folder.call({"--progress", "none", "edit", "diff", "a.edit.toml", "a.edit.toml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("largest difference: none\n"), std::string::npos) << run.out;
}

TEST(EditCommand, MakesARecipeForAMotion) {
  const EditFolder folder;
  const ProgramRun run =
      folder.call({"--progress", "none", "edit", "walk.npz", "--new", "new.edit.toml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(folder.run({}, "new.edit.toml").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "out/walk.npz"));
}

TEST(EditCommand, RefusesAMotionInPlaceOfARecipe) {
  const EditFolder folder;
  const ProgramRun run = folder.run({}, "walk.npz");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("--new RECIPE.edit.toml"), std::string::npos) << run.err;
}

TEST(FilesOfPattern, KnowsNoBrackets) {
  const EditFolder folder;
  fs::copy_file(folder / "walk.npz", folder / "walk[1].npz");
  const auto files = app::files_of_pattern((folder / "walk[1]*.npz").string());
  ASSERT_TRUE(files) << files.error().message();
  EXPECT_EQ(*files, std::vector<fs::path>{folder / "walk[1].npz"});
}

TEST(NamesOfFiles, DifferFromNumberedNamesOfOtherFiles) {
  const auto names = app::names_of_files({"t/x.2.bvh", "t/x.bvh", "t/x.npz"});
  EXPECT_EQ(names, (std::vector<std::string>{"x.2", "x", "x.3"}));
}

TEST(NamesOfFiles, AreTheirPathsBelowTheCommonFolder) {
  const std::vector<fs::path> files{
      "takes/a/motion.npz", "takes/b/motion.npz", "takes/b/motion.bvh"};
  const auto names = app::names_of_files(files);
  EXPECT_EQ(names, (std::vector<std::string>{"a.motion", "b.motion", "b.motion.2"}));
}

}  // namespace
}  // namespace marey::testing
