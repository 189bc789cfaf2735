// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_folder.h"

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "recordings/base/atomic_file.h"
#include "tests/app/library/export/export_scene.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::ExportScene;
using testing::ScratchFolder;

std::string cause_of(const fs::path& out, bool replaces) {
  const Status status = check_export_folder(out, replaces);
  return status ? "" : status.error().cause;
}

Status write_export(const fs::path& out, const std::string& text) {
  const Status ok = recordings::write_file(out / "sub/a.txt", text);
  return ok ? write_manifest(out) : ok;
}

TEST(ExportFolder, HasAManifest) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_export(folder.path(), "abc"));
  EXPECT_EQ(*recordings::read_file(folder / kManifest),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  "
            "sub/a.txt\n");
}

TEST(ExportFolder, IsRefusedWhereOthersHaveFiles) {
  const ScratchFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "full/notes.txt", "x"));
  EXPECT_EQ(cause_of(folder / "full", true),
            "it is not empty, and no earlier export of marey");
  EXPECT_FALSE(cause_of(folder / "full/notes.txt", true).empty());
  EXPECT_EQ(cause_of(folder / "new", false), "");
  fs::create_directory(folder / "empty");
  EXPECT_EQ(cause_of(folder / "empty", false), "");
  ASSERT_TRUE(write_export(folder / "empty", "a"));
  EXPECT_EQ(cause_of(folder / "empty", false), "it is an earlier export");
  EXPECT_EQ(cause_of(folder / "empty", true), "");
  ASSERT_TRUE(recordings::write_file(folder / "empty/mine.txt", "x"));
  EXPECT_EQ(cause_of(folder / "empty", true),
            "\"mine.txt\" in it is not a file of an export");
}

TEST(ExportFolder, KeepsFilesThatAreAddedDuringTheExport) {
  ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kNpz, "e");
  ASSERT_TRUE(scene.run(options));
  options.replaces = true;
  const std::vector<int> selected{0};
  const auto add_file = [&](int, int) {
    EXPECT_TRUE(recordings::write_file(options.out / "mine.txt", "x"));
  };
  const auto report = export_library(options, scene.records(), selected, add_file);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().cause, "\"mine.txt\" in it is not a file of an export");
  EXPECT_TRUE(fs::exists(options.out / "mine.txt"));
  EXPECT_TRUE(fs::exists(options.out / kManifest));
}

// A limit of the size of files stands for a full disk.
TEST(ExportFolder, ReportsAFullDiskAndKeepsTheEarlierExport) {
  const ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kNpz, "e");
  ASSERT_TRUE(scene.run(options));
  const std::string before = testing::hash_folder(options.out);
  options.replaces = true;
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const rlimit small{20000, old.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto report = scene.run(options);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, SIG_DFL);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kDevice) << report.error().message();
  EXPECT_EQ(testing::hash_folder(options.out), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(scene.out("")), {}), 1);
}

}  // namespace
}  // namespace marey::app
