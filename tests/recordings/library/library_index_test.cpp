// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_index.h"

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/library/library_records.h"
#include "tests/support/files/simulated_records.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

std::vector<ClipRecord> some_records(int count) {
  testing::SimulatedRecordsOptions options;
  options.clips = count;
  return testing::simulated_records(options);
}

TEST(LibraryIndex, HasTheSameBytesForTheSameRecords) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_library_index(folder / "a.sqlite", some_records(200)));
  ASSERT_TRUE(write_library_index(folder / "b.sqlite", some_records(200)));
  EXPECT_EQ(*read_file(folder / "a.sqlite"), *read_file(folder / "b.sqlite"));
  ASSERT_TRUE(write_library_index(folder / "a.sqlite", some_records(3)))
      << "an index is replaced";
  EXPECT_EQ(*count_library_clips(folder / "a.sqlite"), 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.sqlite.partial"));
}

TEST(LibraryIndex, IsNotWrittenIntoAFolderThatDoesNotExist) {
  const ScratchFolder folder;
  EXPECT_FALSE(write_library_index(folder / "no folder" / "library.sqlite", {}));
}

}  // namespace
}  // namespace marey::recordings
