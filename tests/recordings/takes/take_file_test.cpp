// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/take_file.h"

#include <csignal>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/files/run_sql.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

Take two_cameras() {
  Take take;
  take.trial = "walk";
  take.started = "2026-11-21T11:56:29Z";
  take.cameras.push_back(
      {"cam0", "cam0.mkv", 1280, 720, {30.0}, "/dev/video0 C920", "gain = 3", {}});
  take.cameras.push_back({"cam1", "cam1.mkv", 640, 480, {29.97}, "/dev/video2", "", {}});
  return take;
}

TakeFrame frame_of(int k) {
  TakeFrame frame;
  frame.time = Timestamp{123456789012345LL + 33333333LL * k};
  frame.sequence = 4000000000U + static_cast<unsigned>(k);
  frame.dropped_before = k % 7 == 0 ? 2 : 0;
  frame.time_is_arrival = k % 5 == 0;
  frame.damaged = k % 11 == 0;
  return frame;
}

void make_take(const fs::path& file) {
  auto writer = TakeWriter::create(file, two_cameras());
  ASSERT_TRUE(writer) << writer.error().message();
  writer->add(0, frame_of(0));
  ASSERT_TRUE(writer->finish());
}

TEST(TakeFile, RoundTripsATake) {
  const ScratchFolder folder;
  auto writer = TakeWriter::create(folder / kTakeFile, two_cameras());
  ASSERT_TRUE(writer) << writer.error().message();
  for (int k = 0; k < 100; ++k) {
    writer->add(k % 2, frame_of(k));
    if (k % 30 == 0) {
      ASSERT_TRUE(writer->commit());
    }
  }
  writer->note({1, Timestamp{5}, "lost: it's \"gone\""});
  ASSERT_TRUE(writer->finish());
  const Result<Take> take = read_take(folder / kTakeFile);
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_EQ(take->trial, "walk");
  EXPECT_EQ(take->started, "2026-11-21T11:56:29Z");
  EXPECT_TRUE(take->finished);
  ASSERT_EQ(take->cameras.size(), 2U);
  EXPECT_EQ(take->cameras[0].file, "cam0.mkv");
  EXPECT_EQ(take->cameras[0].settings, "gain = 3");
  EXPECT_EQ(take->cameras[1].rate.hz, 29.97);
  EXPECT_EQ(take->cameras[1].width_px, 640);
  ASSERT_EQ(take->cameras[1].frames.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) {
    const TakeFrame& frame = take->cameras[1].frames[i];
    const TakeFrame expected = frame_of(2 * static_cast<int>(i) + 1);
    EXPECT_EQ(frame.time, expected.time);
    EXPECT_EQ(frame.sequence, expected.sequence);
    EXPECT_EQ(frame.dropped_before, expected.dropped_before);
    EXPECT_EQ(frame.time_is_arrival, expected.time_is_arrival);
    EXPECT_EQ(frame.damaged, expected.damaged);
  }
  ASSERT_EQ(take->events.size(), 1U);
  EXPECT_EQ(take->events[0].camera, 1);
  EXPECT_EQ(take->events[0].text, "lost: it's \"gone\"");
}

TEST(TakeFile, IsOneFileWhenFinished) {
  const ScratchFolder folder;
  make_take(folder / kTakeFile);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder.path())) {
    ++files;
  }
  EXPECT_EQ(files, 1);
}

/// Returns true if a user without rights can read the take. Precondition: all users may
/// enter its folders.
bool is_readable_without_rights(const fs::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    constexpr unsigned kNobody = 65534;
    const bool is_root = geteuid() == 0;
    if (is_root && (setgid(kNobody) != 0 || setuid(kNobody) != 0)) _exit(1);
    if (access(file.parent_path().c_str(), W_OK) == 0) _exit(2);
    _exit(read_take(file) ? 0 : 3);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

// SQLite interprets "#" and "?" in the names used here.
TEST(TakeFile, IsReadFromAFolderThatMayNotBeWrittenTo) {
  const ScratchFolder scratch;
  const auto everybody_reads = fs::perms::owner_read | fs::perms::group_read |
                               fs::perms::others_read | fs::perms::owner_exec |
                               fs::perms::group_exec | fs::perms::others_exec;
  fs::permissions(scratch.path(), everybody_reads | fs::perms::owner_write);
  for (const char* name : {"plain", "a#b", "q#1?mode=memory", "50%20", "\xC3\xA4"}) {
    const fs::path folder = scratch / name;
    fs::create_directories(folder);
    make_take(folder / kTakeFile);
    fs::permissions(folder / kTakeFile, everybody_reads);
    fs::permissions(folder, everybody_reads);
    EXPECT_TRUE(is_readable_without_rights(folder / kTakeFile)) << name;
    fs::permissions(folder, fs::perms::owner_all);
    EXPECT_TRUE(fs::exists(folder / kTakeFile)) << name;
  }
}

// All committed data are present; added but uncommitted data may be missing.
TEST(TakeFile, KeepsWhatWasCommittedWhenItsProcessIsKilled) {
  const ScratchFolder folder;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto writer = TakeWriter::create(folder / kTakeFile, two_cameras());
    for (int k = 0; k < 500; ++k) writer->add(0, frame_of(k));
    const bool committed = writer->commit().has_value();
    for (int k = 500; k < 600; ++k) writer->add(0, frame_of(k));
    if (committed) raise(SIGKILL);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  const Result<Take> take = read_take(folder / kTakeFile);
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_FALSE(take->finished);
  ASSERT_EQ(take->cameras[0].frames.size(), 500U);
  EXPECT_EQ(take->cameras[0].frames[499].time, frame_of(499).time);
}

TEST(TakeFile, IsNotWrittenOverAnother) {
  const ScratchFolder folder;
  make_take(folder / kTakeFile);
  const auto second = TakeWriter::create(folder / kTakeFile, two_cameras());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kBadInput);
  EXPECT_EQ(second.error().cause, "a recording already exists");
}

TEST(TakeFile, ReportsAMissingFile) {
  const ScratchFolder folder;
  const Result<Take> take = read_take(folder / kTakeFile);
  ASSERT_FALSE(take);
  EXPECT_EQ(take.error().where, (folder / kTakeFile).string());
  EXPECT_EQ(take.error().cause,
            "the file does not exist, so the times of the frames are unknown");
}

TEST(TakeFile, ReportsANewerVersion) {
  const ScratchFolder folder;
  make_take(folder / kTakeFile);
  testing::run_sql(folder / kTakeFile, "PRAGMA user_version=2");
  const Result<Take> take = read_take(folder / kTakeFile);
  ASSERT_FALSE(take);
  EXPECT_EQ(
      take.error().cause,
      "it was recorded by a newer version of marey (format 2, this version reads 1)");
  EXPECT_EQ(take.error().next, "install that version");
}

TEST(TakeFile, ReportsAFileOfAnotherFormat) {
  const ScratchFolder folder;
  for (const std::string& bytes :
       {std::string(), std::string("not a database"), std::string(5000, 'x')}) {
    ASSERT_TRUE(write_file(folder / "other.sqlite", bytes));
    const Result<Take> take = read_take(folder / "other.sqlite");
    ASSERT_FALSE(take);
    EXPECT_EQ(take.error().cause, "it is not the database of a take, or it is damaged");
  }
}

TEST(TakeFile, ReportsAMissingTableOrFrame) {
  const ScratchFolder folder;
  make_take(folder / kTakeFile);
  testing::run_sql(folder / kTakeFile, "UPDATE frame SET number=3");
  EXPECT_FALSE(read_take(folder / kTakeFile));
  testing::run_sql(folder / kTakeFile, "DROP TABLE frame");
  EXPECT_FALSE(read_take(folder / kTakeFile));
}

TEST(TakeFile, ReportsValuesThatNoRecorderWrites) {
  const ScratchFolder folder;
  for (const char* change :
       {"UPDATE frame SET time_ns = -1 WHERE number = 0",
        "UPDATE frame SET time_ns = time_ns - 1000000000 WHERE number = 2",
        "UPDATE frame SET time_ns = 9223372036854775807 WHERE number = 2",
        "UPDATE frame SET time_ns = -9223372036854775807 WHERE number = 1",
        "UPDATE frame SET dropped_before = -1 WHERE number = 1",
        "UPDATE frame SET dropped_before = 4294967296 WHERE number = 1",
        "UPDATE frame SET camera = -1 WHERE number = 1",
        "UPDATE frame SET camera = 2 WHERE number = 1",
        "UPDATE camera SET rate_hz = 9e999",
        "UPDATE camera SET file = '../cam0.mkv'",
        "INSERT INTO event VALUES(2, 5, 'without camera')"}) {
    fs::remove(folder / kTakeFile);
    auto writer = TakeWriter::create(folder / kTakeFile, two_cameras());
    ASSERT_TRUE(writer);
    for (int k = 0; k < 3; ++k) writer->add(0, frame_of(k));
    ASSERT_TRUE(writer->finish());
    ASSERT_TRUE(read_take(folder / kTakeFile));
    testing::run_sql(folder / kTakeFile, change);
    const Result<Take> take = read_take(folder / kTakeFile);
    ASSERT_FALSE(take) << change;
    EXPECT_EQ(take.error().cause, "it is not the database of a take, or it is damaged");
  }
}

// Only complete data are ever returned.
TEST(TakeFile, IsReportedOrReadWholeWhenTruncatedAnywhere) {
  const ScratchFolder folder;
  auto writer = TakeWriter::create(folder / kTakeFile, two_cameras());
  ASSERT_TRUE(writer);
  for (int k = 0; k < 500; ++k) writer->add(k % 2, frame_of(k));
  ASSERT_TRUE(writer->finish());
  const Result<std::string> whole = read_file(folder / kTakeFile);
  ASSERT_TRUE(whole);
  for (std::size_t size = 0; size <= whole->size(); size += 512) {
    ASSERT_TRUE(write_file(folder / "cut.sqlite", whole->substr(0, size)));
    const Result<Take> take = read_take(folder / "cut.sqlite");
    EXPECT_TRUE(take || size < whole->size());
    if (!take) {
      EXPECT_EQ(take.error().code, Errc::kBadInput);
      continue;
    }
    ASSERT_EQ(take->cameras.size(), 2U);
    for (std::size_t c = 0; c < 2; ++c) {
      const auto& frames = take->cameras[c].frames;
      ASSERT_EQ(frames.size(), 250U) << size;
      for (std::size_t i = 0; i < 250; ++i) {
        EXPECT_EQ(frames[i].time, frame_of(static_cast<int>(2 * i + c)).time);
      }
    }
  }
}

// The message has the first error, not a consequence of it.
TEST(TakeFile, ReportsAFailedCreationAndLeavesNoFile) {
  const ScratchFolder folder;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{3000, 3000};  // Less than a page.
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(1);
    const auto writer = TakeWriter::create(folder / kTakeFile, two_cameras());
    if (writer || writer.error().code != Errc::kDevice) _exit(2);
    const std::string& cause = writer.error().cause;
    const bool is_expected = cause.rfind("the take cannot be started: ", 0) == 0 &&
                             cause.find("no such table") == std::string::npos &&
                             cause.find("not an error") == std::string::npos;
    _exit(is_expected ? 0 : 3);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace marey::recordings
