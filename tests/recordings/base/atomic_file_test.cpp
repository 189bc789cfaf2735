// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/atomic_file.h"

#include <csignal>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;
namespace fs = std::filesystem;

void remove_file(const char* path) {
  unlink(path);
}

std::vector<std::string> files_in(const ScratchFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

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
  EXPECT_EQ(files_in(folder), std::vector<std::string>{"a.txt"});
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
  EXPECT_EQ(files_in(folder), std::vector<std::string>{"a.txt"});
}

// As a signal handler finds them: one file open, one committed, one discarded.
TEST(AtomicFile, CanBeRemovedWhileItIsBeingWritten) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "done.txt", "done"));
  { const auto given_up = AtomicFile::create(folder / "given up.txt"); }
  Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
  ASSERT_TRUE(file);
  file->append("new");
  EXPECT_EQ(files_in(folder).size(), 2U);
  visit_partial_files(remove_file);
  EXPECT_EQ(files_in(folder), std::vector<std::string>{"done.txt"});
  EXPECT_FALSE(file->commit());
}

TEST(AtomicFile, LeavesNothingForASignalToRemoveOnceItIsDone) {
  const ScratchFolder folder;
  for (int i = 0; i < 100; ++i) {  // More than the limit of remembered files.
    ASSERT_TRUE(write_file(folder / "a.txt", "a"));
    ASSERT_FALSE(write_file(folder / std::string(250, 'x'), "too long a name"));
  }
  const Result<AtomicFile> file = AtomicFile::create(folder / "b.txt");
  visit_partial_files(remove_file);
  EXPECT_EQ(files_in(folder), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFileDeathTest, IsRemovedByAHandlerThatEndsTheProcess) {
  const ScratchFolder folder;
  const auto write_for_ever = [&] {
    std::signal(SIGTERM, [](int) {
      visit_partial_files(remove_file);
      _exit(130);
    });
    Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    file->append(std::string(1U << 20, 'a'));
    if (files_in(folder).size() != 1) _exit(1);
    (void)std::raise(SIGTERM);
  };
  EXPECT_EXIT(write_for_ever(), ::testing::ExitedWithCode(130), "");
  EXPECT_EQ(files_in(folder), std::vector<std::string>{});
}

// Starts a process that writes "a.txt" and is killed meanwhile, or waits for `stop`.
pid_t start_writer(const fs::path& path, int ready, bool is_killed) {
  const pid_t child = fork();
  if (child != 0) return child;
  Result<AtomicFile> file = AtomicFile::create(path);
  if (file) file->append(std::string(1U << 20, 'a'));
  (void)!write(ready, "r", 1);
  if (is_killed) (void)raise(SIGKILL);
  for (;;) pause();
}

TEST(AtomicFile, ProcessesThatWriteTheSameFileAtOnceAllSucceed) {
  const ScratchFolder folder;
  std::vector<pid_t> writers;
  for (int i = 0; i < 4; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      bool all = true;
      for (int k = 0; k < 1000 && all; ++k) {
        all = bool(write_file(folder / "a.txt", "same", OnDisk::kNow));
      }
      _exit(all ? 0 : 1);
    }
    writers.push_back(child);
  }
  for (const pid_t writer : writers) {
    int status = -1;
    ASSERT_EQ(waitpid(writer, &status, 0), writer);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(files_in(folder), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFile, RemovesTheFilesThatAKilledProcessLeft) {
  const ScratchFolder folder;
  int pipe_ends[2] = {-1, -1};
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t killed = start_writer(folder / "a.txt", pipe_ends[1], true);
  ASSERT_EQ(waitpid(killed, nullptr, 0), killed);
  ASSERT_EQ(files_in(folder).size(), 1U);
  EXPECT_NE(files_in(folder)[0].find(".partial"), std::string::npos);
  ASSERT_TRUE(write_file(folder / "b.txt", "of another file"));
  EXPECT_EQ(files_in(folder).size(), 2U);
  ASSERT_TRUE(write_file(folder / "a.txt", "new"));
  EXPECT_EQ(files_in(folder).size(), 2U);
  EXPECT_EQ(*read_file(folder / "a.txt"), "new");
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST(AtomicFile, KeepsTheFilesOfALivingProcess) {
  const ScratchFolder folder;
  int pipe_ends[2] = {-1, -1};
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t living = start_writer(folder / "a.txt", pipe_ends[1], false);
  char byte = 0;
  ASSERT_EQ(read(pipe_ends[0], &byte, 1), 1);
  ASSERT_TRUE(write_file(folder / "a.txt", "new"));
  EXPECT_EQ(files_in(folder).size(), 2U);
  kill(living, SIGKILL);
  ASSERT_EQ(waitpid(living, nullptr, 0), living);
  ASSERT_TRUE(write_file(folder / "a.txt", "newer"));
  EXPECT_EQ(files_in(folder), std::vector<std::string>{"a.txt"});
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST(AtomicFile, AbandonedFilesBelowAFolderAreRemoved) {
  const ScratchFolder folder;
  int pipe_ends[2] = {-1, -1};
  ASSERT_EQ(pipe(pipe_ends), 0);
  fs::create_directories(folder / "deep");
  const pid_t killed = start_writer(folder / "deep/a.txt", pipe_ends[1], true);
  ASSERT_EQ(waitpid(killed, nullptr, 0), killed);
  int living_ends[2] = {-1, -1};
  ASSERT_EQ(pipe(living_ends), 0);
  const pid_t living = start_writer(folder / "b.txt", living_ends[1], false);
  char byte = 0;
  ASSERT_EQ(read(living_ends[0], &byte, 1), 1);
  ASSERT_TRUE(write_file(folder / "c.txt", "whole"));
  ASSERT_FALSE(fs::is_empty(folder / "deep"));
  remove_abandoned_files(folder.path());
  EXPECT_TRUE(fs::is_empty(folder / "deep"));
  EXPECT_EQ(files_in(folder).size(), 3U);
  kill(living, SIGKILL);
  ASSERT_EQ(waitpid(living, nullptr, 0), living);
  remove_abandoned_files(folder.path());
  EXPECT_EQ(files_in(folder).size(), 2U);
  for (const int end : {pipe_ends[0], pipe_ends[1], living_ends[0], living_ends[1]}) {
    close(end);
  }
}

TEST(AtomicFile, NeitherFollowsNorRemovesLinksAndOtherNames) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "victim", "mine"));
  fs::create_symlink(folder / "victim", folder / "a.txt.1.partial");
  ASSERT_EQ(mkfifo((folder / "a.txt.2.partial").c_str(), 0600), 0);
  fs::create_hard_link(folder / "victim", folder / "a.txt.3.partial");
  for (const char* name : {"a.txt.partial", "a.txt.x1.partial", "b.txt.1.partial"}) {
    ASSERT_TRUE(write_file(folder / name, "mine"));
  }
  ASSERT_TRUE(write_file(folder / "a.txt", "new"));
  EXPECT_EQ(files_in(folder).size(), 8U);
  EXPECT_EQ(*read_file(folder / "victim"), "mine");
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

TEST(AtomicFile, LeavesPipesAndDevicesAsTheyAre) {
  const ScratchFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const Result<AtomicFile> file = AtomicFile::create(pipe);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, Errc::kBadInput);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

// Reading a pipe would block, and reading a device would fill the memory.
TEST(ReadFile, DeclinesPipesDevicesAndTooLargeFiles) {
  const ScratchFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "zero");
  std::ofstream(folder / "large") << "a";
  fs::resize_file(folder / "large", std::uintmax_t{1} << 40);  // A sparse file.
  for (const char* name : {"pipe", "zero", "large"}) {
    const auto bytes = read_file(folder / name);
    ASSERT_FALSE(bytes) << name;
    EXPECT_EQ(bytes.error().code, Errc::kBadInput) << name;
  }
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
  // The word in its name ends with a count of files.
  constexpr std::string_view kEnd = ".partial";
  std::string name;
  while (name.empty() || *name.rbegin() == '9') {
    const Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    name = files_in(folder).at(0);
    name.erase(name.size() - kEnd.size());
  }
  ++*name.rbegin();
  const fs::path partial = folder / (name + std::string(kEnd));
  fs::create_symlink("/dev/full", partial);
  const Status status = write_file(folder / "a.txt", "a");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::kDevice);
  EXPECT_EQ(status.error().cause,
            "the file could not be written to its end: No space left on device");
  EXPECT_EQ(status.error().next, "free some disk space and run again");
  EXPECT_FALSE(fs::exists(fs::symlink_status(partial)));
}

TEST(ReadFile, NamesAFileThatDoesNotExist) {
  const ScratchFolder folder;
  const Result<std::string> text = read_file(folder / "absent.txt");
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().message(),
            (folder / "absent.txt").string() +
                ": the file does not exist. Next: check the name and the folder.");
}

TEST(ReadFile, DoesNotTakeAFileThatItCannotAskForForAbsent) {
  const ScratchFolder folder;
  const Result<std::string> text = read_file(folder / std::string(300, 'x'));
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().cause, "the file cannot be read: File name too long");
}

TEST(ReadFile, DeclinesAFolder) {
  const ScratchFolder folder;
  const Result<std::string> text = read_file(folder.path());
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().cause, "this is a folder, not a file");
}

}  // namespace
}  // namespace marey::recordings
