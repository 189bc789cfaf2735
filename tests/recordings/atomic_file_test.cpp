// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/atomic_file.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/recordings/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

TEST(AtomicFile, GivesBackEveryByteWritten) {
  const ScratchFolder folder;
  std::string bytes;
  for (int i = 0; i < 3'000'000; ++i) bytes.push_back(static_cast<char>(i * 7));
  ASSERT_TRUE(write_file(folder / "a.bin", bytes));
  const Result<std::string> back = read_file(folder / "a.bin");
  ASSERT_TRUE(back);
  EXPECT_TRUE(*back == bytes);
}

TEST(AtomicFile, CreatesParentFolders) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "x/y/a.txt", "a"));
  EXPECT_TRUE(fs::exists(folder / "x/y/a.txt"));
}

TEST(AtomicFile, LeavesNoPartialFileBehindACommit) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.txt", "a"));
  EXPECT_FALSE(fs::exists(folder / "a.txt.partial"));
}

TEST(AtomicFile, WithoutCommitTheOldFileStaysAndThePartialGoes) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "a.txt", "old"));
  {
    Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    file->append("new");
  }
  EXPECT_EQ(*read_file(folder / "a.txt"), "old");
  EXPECT_FALSE(fs::exists(folder / "a.txt.partial"));
}

TEST(AtomicFile, SurvivesBeingMoved) {
  const ScratchFolder folder;
  {
    Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    AtomicFile moved = *std::move(file);
    moved.append("new");
    ASSERT_TRUE(moved.commit());
  }
  EXPECT_EQ(*read_file(folder / "a.txt"), "new");
}

TEST(AtomicFile, DeclinesAFileWhereAFolderIs) {
  const ScratchFolder folder;
  fs::create_directories(folder / "taken");
  const Status status = write_file(folder / "taken", "a");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().cause, "a folder is in the way of the file");
}

TEST(AtomicFile, DeclinesAFolderWhereAFileIs) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "taken", "a"));
  const Status status = write_file(folder / "taken/a.txt", "a");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::kBadInput);
  EXPECT_NE(status.error().cause.find("the folder cannot be created"), std::string::npos);
}

TEST(AtomicFile, AFullDiskIsADeviceErrorAndLeavesNothing) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const ScratchFolder folder;
  fs::create_symlink("/dev/full", folder / "a.txt.partial");
  const Status status = write_file(folder / "a.txt", "a");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::kDevice);
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder / "a.txt.partial")));
}

TEST(ReadFile, NamesAFileThatDoesNotExist) {
  const ScratchFolder folder;
  const Result<std::string> text = read_file(folder / "absent.txt");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().message(),
            (folder / "absent.txt").string() +
                ": the file does not exist. Next: check the name and the folder.");
}

TEST(ReadFile, DeclinesAFolder) {
  const ScratchFolder folder;
  const Result<std::string> text = read_file(folder.path());
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().cause, "this is a folder, not a file");
}

}  // namespace
}  // namespace marey::recordings
