// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/folder_lock.h"

#include <filesystem>
#include <string>
#include <thread>
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
        const FolderLock lock(folder.path());
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

TEST(FolderLock, HasNoEffectWithoutAFolder) {
  const testing::ScratchFolder folder;
  const FolderLock first(folder / "absent");
  const FolderLock second(folder / "absent");
}

}  // namespace
}  // namespace marey::recordings
