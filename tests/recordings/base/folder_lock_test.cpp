// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/folder_lock.h"

#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

TEST(FolderLock, KeepsTheLinesOfAllWriters) {
  const testing::ScratchFolder folder;
  const std::filesystem::path file = folder / "table.csv";
  ASSERT_TRUE(write_file(file, ""));
  constexpr int kWriters = 4;
  constexpr int kLines = 25;
  std::vector<std::thread> writers;
  for (int writer = 0; writer < kWriters; ++writer) {
    writers.emplace_back([&] {
      for (int i = 0; i < kLines; ++i) {
        const auto lock = FolderLock::take(folder.path());
        if (!lock) return;
        auto text = read_file(file);
        if (text) (void)write_file(file, *text + "line\n");
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  const auto text = read_file(file);
  ASSERT_TRUE(text);
  EXPECT_EQ(text->size(), std::string("line\n").size() * kWriters * kLines);
}

TEST(FolderLock, NeedsAFolder) {
  const testing::ScratchFolder folder;
  const auto lock = FolderLock::take(folder / "absent");
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().code, Errc::kDevice);
  EXPECT_EQ(lock.error().where, (folder / "absent").string());
}

TEST(FolderLock, CanBeMovedAndTakenAgain) {
  const testing::ScratchFolder folder;
  {
    auto lock = FolderLock::take(folder.path());
    ASSERT_TRUE(lock);
    const FolderLock moved = *std::move(lock);
  }
  EXPECT_TRUE(FolderLock::take(folder.path()));
}

}  // namespace
}  // namespace marey::recordings
