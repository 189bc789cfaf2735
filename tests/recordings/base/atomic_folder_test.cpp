// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/atomic_folder.h"

#include <filesystem>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

Status write_folder(const fs::path& path, const std::string& text) {
  auto folder = AtomicFolder::create(path);
  if (!folder) return folder.error();
  const Status ok = write_file(folder->partial() / "sub/a.txt", text);
  return ok ? folder->commit() : ok;
}

auto entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(AtomicFolder, AppearsAsAWhole) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_folder(folder / "new/deeper/", "abc"));
  EXPECT_EQ(*read_file(folder / "new/deeper/sub/a.txt"), "abc");
  EXPECT_EQ(entries(folder / "new"), 1);
  fs::create_directory(folder / "empty");
  ASSERT_TRUE(write_folder(folder / "empty", "abc"));
}

TEST(AtomicFolder, ReplacesAnEarlierOneAsAWhole) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_folder(folder / "e", "first"));
  ASSERT_TRUE(write_file(folder / "e/more.txt", "x"));
  ASSERT_TRUE(write_folder(folder / "e", "second"));
  EXPECT_EQ(*read_file(folder / "e/sub/a.txt"), "second");
  EXPECT_FALSE(fs::exists(folder / "e/more.txt"));
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(AtomicFolder, LeavesNothingWithoutCommitAndHasOneWriter) {
  const ScratchFolder folder;
  {
    auto one = AtomicFolder::create(folder / "e");
    ASSERT_TRUE(one);
    ASSERT_TRUE(write_file(one->partial() / "a", "x"));
    const auto two = AtomicFolder::create(folder / "e");
    ASSERT_FALSE(two);
    EXPECT_EQ(two.error().cause, "another process is writing this folder");
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(AtomicFolder, RemovesThePartialFolderOfAKilledProcess) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / ".e.marey-partial/old", "x"));
  ASSERT_TRUE(write_folder(folder / "e", "a"));
  EXPECT_FALSE(fs::exists(folder / "e/old"));
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(AtomicFolder, ReportsAFolderThatCannotBeMade) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "file", "x"));
  const auto made = AtomicFolder::create(folder / "file/e");
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::kDevice);
}

}  // namespace
}  // namespace marey::recordings
