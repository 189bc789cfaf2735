// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Bad input, bad places and long recipes for the program `marey edit`. Each refusal names
// the file, the cause and the next step, and leaves nothing half written.
#include <csignal>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/app/edit/edit_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

/// Expects exit code 3, the parts of the message, a next step and no results.
void expect_refused(const ProgramRun& run, const std::vector<std::string>& parts) {
  EXPECT_EQ(run.exit_code, 3) << run.err;
  for (const std::string& part : parts) {
    EXPECT_NE(run.err.find(part), std::string::npos) << part << "\n" << run.err;
  }
  EXPECT_NE(run.err.find("Next:"), std::string::npos) << run.err;
}

TEST(EditTrouble, RecipesThatCannotBeRead) {
  const EditFolder folder;
  const std::string head = "format = 1\n[source]\npath = \"walk.npz\"\n";
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
      {"", {"the file is empty"}},
      {std::string("\0\1\2\xff\xfe", 5), {"a.edit.toml"}},
      {std::string((std::size_t{16} << 20) + 1, '\n'), {"larger than 16 MiB"}},
      {"format = 2\n[source]\npath = \"walk.npz\"\n", {"a.edit.toml:1", "update marey"}},
      {head + "[[op]]\ndo = \"cut@2\"\n", {"a.edit.toml:5", "cut@2", "update marey"}},
      {head + "[[op]]\ndo = \"cut@0\"\n", {"a.edit.toml:5"}},
      {head + "[[op]]\ndo = \"cur@1\"\n", {"a.edit.toml:5", "perhaps you mean"}},
      {head + "[[op]]\ndo = \"cut@1\"\nfrom_s = nan\n", {"a.edit.toml:6", "finite"}},
      {head + "[[op]]\ndo = \"cut@1\"\nfrom_s = 2\nto_s = 1\n", {"a.edit.toml:"}},
      {head + "[[op]]\ndo = \"cut@1\"\nfrom_s = 20\n",
       {"a.edit.toml:4: cut@1", "lies outside", "choose an instant within"}},
      {head + "[[op]]\ndo = \"cut@1\"\nfrom = \"gone\"\n",
       {"a.edit.toml:4: cut@1", "has no annotation \"gone\""}},
      {head + "[[op]]\ndo = \"cut@1\"\nto_s = 0.5\n[[op]]\ndo = \"cut@1\"\n"
              "from = \"left.strike[2]\"\n",
       {"a.edit.toml:7: cut@1", "left.strike"}}};
  for (const auto& [text, parts] : cases) {
    ASSERT_TRUE(recordings::write_file(folder / "a.edit.toml", text));
    expect_refused(folder.run(), parts);
    EXPECT_FALSE(fs::exists(folder / "out")) << text.substr(0, 200);
  }
  fs::remove(folder / "a.edit.toml");
  expect_refused(folder.run(), {"a.edit.toml", "does not exist"});
  fs::create_directory(folder / "a.edit.toml");
  expect_refused(folder.run(), {"a.edit.toml", "folder"});
}

TEST(EditTrouble, SourcesThatCannotBeEdited) {
  const EditFolder folder;
  const std::string frames =
      "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
      "Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}\nMOTION\nFrames: ";
  Motion broken = synthetic_walk(30, 120.0).motion;
  broken.poses[17].root_in_world.y = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(recordings::write_npz(folder / "nan.npz", broken));
  broken.poses.clear();
  ASSERT_TRUE(recordings::write_npz(folder / "none.npz", broken));
  ASSERT_TRUE(
      recordings::write_file(folder / "none.bvh", frames + "0\nFrame Time: 0.01\n"));
  ASSERT_TRUE(recordings::write_file(folder / "nan.bvh",
                                     frames + "1\nFrame Time: 0.01\n0 nan 0 0 0 0\n"));
  const std::string walk = folder.bytes("walk.npz");
  ASSERT_TRUE(recordings::write_file(folder / "short.npz",
                                     std::string_view(walk).substr(0, walk.size() / 2)));
  fs::create_directory(folder / "empty");
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
      {"nan.npz", {"nan.npz", "not finite"}},
      {"none.npz", {"none.npz"}},
      {"none.bvh", {"none.bvh"}},
      {"nan.bvh", {"nan.bvh"}},
      {"short.npz", {"short.npz", "damaged"}},
      {"empty", {"empty", "folder without motion.npz"}},
      {"gone/away.bvh", {"away.bvh", "does not exist", "recipe's folder"}}};
  for (const auto& [source, parts] : cases) {
    folder.write_recipe("", "path = \"" + source + "\"");
    const ProgramRun run = folder.run();
    expect_refused(run, parts);
    EXPECT_NE(run.err.find("a.edit.toml:3"), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
}

TEST(EditTrouble, OneChangedByteOfAPinnedSource) {
  const EditFolder folder;
  folder.write_recipe("");
  ASSERT_EQ(folder.run({"--pin"}).exit_code, 0);
  fs::remove_all(folder / "out");
  std::string bytes = folder.bytes("walk.npz");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  ASSERT_TRUE(recordings::write_file(folder / "walk.npz", bytes));
  expect_refused(folder.run(),
                 {"a.edit.toml:", "walk.npz", "another content", "--accept-new-source"});
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(EditTrouble, RecipesThatAreTheirOwnSource) {
  const EditFolder folder;
  folder.write_recipe("", "path = \"a.edit.toml\"");
  expect_refused(folder.run(), {"a.edit.toml", "is a source of itself"});
  folder.write_recipe("", "path = \"b.edit.toml\"");
  folder.write_recipe("", "path = \"c.edit.toml\"", "b.edit.toml");
  folder.write_recipe("", "path = \"./x/../a.edit.toml\"", "c.edit.toml");
  fs::create_directory(folder / "x");
  expect_refused(folder.run(), {"a.edit.toml", "is a source of itself", "c.edit.toml"});
  fs::create_symlink("a.edit.toml", folder / "link.edit.toml");
  folder.write_recipe("", "path = \"link.edit.toml\"", "c.edit.toml");
  expect_refused(folder.run(), {"is a source of itself"});
  // The second source of a recipe closes the circle.
  ASSERT_TRUE(recordings::write_file(
      folder / "c.edit.toml",
      "format = 1\n[[source]]\npath = \"walk.npz\"\n[[source]]\nid = \"x\"\n"
      "path = \"a.edit.toml\"\n"));
  expect_refused(folder.run(), {"is a source of itself"});
}

TEST(EditTrouble, FoldersThatCannotHoldResults) {
  const EditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"cut@1\"\nto_frame = 40\n");
  ASSERT_TRUE(recordings::write_file(folder / "out", "a file"));
  expect_refused(folder.run(), {"out", "is not a folder", "--out"});
  EXPECT_EQ(folder.bytes("out"), "a file");
  fs::remove(folder / "out");
  fs::create_directories(folder / "out/a.npz");
  expect_refused(folder.run(), {"a.npz", "a folder is in the way"});
  fs::remove_all(folder / "out");
  if (geteuid() == 0) GTEST_SKIP() << "root writes to any folder";
  fs::create_directory(folder / "out");
  fs::permissions(folder / "out", fs::perms::owner_read | fs::perms::owner_exec);
  expect_refused(folder.run(), {"out", "written to"});
  fs::permissions(folder / "out", fs::perms::owner_all);
  EXPECT_TRUE(fs::is_empty(folder / "out"));
}

/// Contents of the files in a folder, by name.
std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> out;
  if (!fs::exists(folder)) return out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    out[entry.path().filename().string()] = *recordings::read_file(entry.path());
  }
  return out;
}

/// Runs the recipe in a process whose files may not grow beyond `bytes`.
int exit_code_with_small_files(const EditFolder& folder, rlim_t bytes) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
    const ProgramRun run = folder.run();
    const bool names_file = run.err.find("out/a.") != std::string::npos &&
                            run.err.find("Next:") != std::string::npos;
    _exit(names_file || run.exit_code == 0 ? run.exit_code : 98);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

TEST(EditTrouble, FullDisksLeaveNothingHalfWritten) {
  const EditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"cut@1\"\nfrom_s = 0.5\n");
  ASSERT_EQ(folder.run().exit_code, 0);
  const auto whole = files_in(folder / "out");
  ASSERT_GE(whole.size(), 5U);
  std::set<std::size_t> sizes{600, 4096, 20000};
  for (const auto& [name, bytes] : whole) sizes.insert(bytes.size() - 1);
  for (const bool has_older_results : {false, true}) {
    for (const std::size_t size : sizes) {
      fs::remove_all(folder / "out");
      std::map<std::string, std::string> before;
      if (has_older_results) {
        for (const auto& [name, bytes] : whole) {
          ASSERT_TRUE(recordings::write_file(folder / ("out/" + name), "older"));
          before[name] = "older";
        }
      }
      EXPECT_EQ(exit_code_with_small_files(folder, size), 5) << size;
      for (const auto& [name, bytes] : files_in(folder / "out")) {
        ASSERT_TRUE(whole.contains(name)) << name << " is left behind";
        const bool is_older = has_older_results && bytes == "older";
        EXPECT_TRUE(is_older || bytes == whole.at(name)) << name << " is not whole";
      }
    }
  }
}

TEST(EditTrouble, RecipesOfAThousandOperationsAndMore) {
  const EditFolder folder;
  std::string ops = "[[op]]\ndo = \"cut@1\"\nfrom_frame = 100\n";
  for (int i = 0; i < 499; ++i) {
    ops +=
        "[[op]]\ndo = \"mirror@1\"\n[[op]]\ndo = \"offset@1\"\nbone = \"head\"\n"
        "rotation_deg = [0, " +
        std::to_string(i % 3 - 1) + ", 0]\n";
  }
  folder.write_recipe(ops);
  const ProgramRun run = folder.run({"--format", "npz"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(folder.bytes("out/a.edit.json"));
  EXPECT_EQ(json.at("operations").size(), 999U);
  EXPECT_EQ(json.at("results")[0].at("lineage")[0].at("operations").size(), 999U);
  ops.clear();
  for (int i = 0; i < 10000; ++i) {
    ops += "[[op]]\ndo = \"event@1\"\ntext = \"e" + std::to_string(i % 7) +
           "\"\nat_frame = " + std::to_string(i % 360) + "\n";
  }
  folder.write_recipe(ops);
  const ProgramRun most = folder.run({"--format", "npz"});
  ASSERT_EQ(most.exit_code, 0) << most.err;
  const auto notes = nlohmann::json::parse(folder.bytes("out/a.annotations.json"));
  EXPECT_GE(notes.at("notes").size(), 360U);
}

TEST(EditTrouble, AMotionOfOneFrame) {
  const EditFolder folder;
  ASSERT_TRUE(
      recordings::write_npz(folder / "walk.npz", synthetic_walk(1, 120.0).motion));
  folder.write_recipe(
      "[[op]]\ndo = \"mirror@1\"\n[[op]]\ndo = \"filter@1\"\n"
      "[[op]]\ndo = \"plant@1\"\n[[op]]\ndo = \"tag@1\"\ntext = \"a\"\n");
  const ProgramRun run = folder.run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto result = recordings::read_npz(folder / "out/a.npz");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->motion.poses.size(), 1U);
  folder.write_recipe("[[op]]\ndo = \"cyclify@1\"\n");
  expect_refused(folder.run(), {"a.edit.toml:5: cyclify@1"});
}

}  // namespace
}  // namespace marey::testing
