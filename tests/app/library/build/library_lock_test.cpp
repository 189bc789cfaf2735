// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/library_lock.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    out.push_back(entry.path().filename().string());
  }
  return out;
}

/// Begins a process that takes the lock and is killed with it.
void die_with_lock(const fs::path& library) {
  const pid_t child = fork();
  if (child == 0) {
    const auto lock = LibraryLock::take(library);
    if (!lock) _exit(1);
    ::kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
}

/// Takes the lock again and again. Returns false if another process held it meanwhile.
bool holds_alone(const fs::path& library, int times) {
  const std::string inside = (library / "inside").string();
  for (int taken = 0; taken < times;) {
    const auto lock = LibraryLock::take(library);
    if (!lock) continue;
    const int file = open(inside.c_str(), O_CREAT | O_EXCL | O_WRONLY, 0600);
    if (file < 0) return false;
    close(file);
    unlink(inside.c_str());
    ++taken;
  }
  return true;
}

TEST(LibraryLock, IsGivenBack) {
  const testing::ScratchFolder library;
  {
    const auto lock = LibraryLock::take(library.path());
    ASSERT_TRUE(lock) << lock.error().message();
    EXPECT_EQ(names_in(library.path()), std::vector<std::string>{"LOCK"});
    const auto second = LibraryLock::take(library.path());
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message().find("process"), std::string::npos);
  }
  EXPECT_TRUE(names_in(library.path()).empty());
}

TEST(LibraryLock, IsTakenOverFromAKilledProcess) {
  const testing::ScratchFolder library;
  die_with_lock(library.path());
  EXPECT_TRUE(fs::exists(library / "LOCK"));
  { EXPECT_TRUE(LibraryLock::take(library.path())); }
  EXPECT_TRUE(names_in(library.path()).empty());
}

TEST(LibraryLock, StaysWithAnotherHost) {
  const testing::ScratchFolder library;
  std::ofstream(library / "LOCK") << "elsewhere 17 4711 pid:[1]\n";
  const auto lock = LibraryLock::take(library.path());
  ASSERT_FALSE(lock);
  EXPECT_NE(lock.error().message().find("elsewhere"), std::string::npos);
  EXPECT_EQ(names_in(library.path()), std::vector<std::string>{"LOCK"});
}

TEST(LibraryLock, HasOneHolderAmongManyProcesses) {
  const testing::ScratchFolder library;
  for (int round = 0; round < 5; ++round) {
    die_with_lock(library.path());
    std::vector<pid_t> children;
    constexpr int kProcesses = 6;
    for (int i = 0; i < kProcesses; ++i) {
      const pid_t child = fork();
      if (child == 0) _exit(holds_alone(library.path(), 20) ? 0 : 1);
      children.push_back(child);
    }
    for (const pid_t child : children) {
      int status = 0;
      ASSERT_EQ(waitpid(child, &status, 0), child);
      EXPECT_EQ(status, 0);
    }
  }
  EXPECT_TRUE(names_in(library.path()).empty());
}

TEST(LibraryLock, RemovesWhatAKilledProcessLeftWhileTakingIt) {
  const testing::ScratchFolder library;
  die_with_lock(library.path());
  const std::string lock = (library / "LOCK").string();
  fs::copy_file(lock, lock + ".takeover");
  fs::copy_file(lock, lock + ".host.12");
  { EXPECT_TRUE(LibraryLock::take(library.path())); }
  EXPECT_TRUE(names_in(library.path()).empty());
}

}  // namespace
}  // namespace marey::app
