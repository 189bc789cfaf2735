// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recordings/base/atomic_file.h"
#include "recordings/library/index_head.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/library_records.h"
#include "recordings/library/version_file.h"
#include "tests/app/library/build/walk_library.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using marey::testing::program;
using marey::testing::ProgramRun;
using marey::testing::read_text;
using marey::testing::run_program;
using recordings::LibraryPaths;

ProgramRun library_command(std::vector<std::string> words) {
  words.insert(words.begin(), "library");
  return run_program(program(), words);
}

ProgramRun build(const fs::path& library, const std::string& jobs = "2") {
  return library_command({"build", library.string(), "--jobs", jobs, "--json"});
}

nlohmann::json result(const ProgramRun& run) {
  return nlohmann::json::parse(run.out, nullptr, false);
}

void write_text(const fs::path& file, const std::string& text) {
  ASSERT_TRUE(recordings::write_file(file, text));
}

TEST(LibraryBuild, MakesAClipOfEverySource) {
  const WalkLibrary walks(3);
  const fs::path library = walks.make("library");
  const ProgramRun run = build(library);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(result(run).at("clips"), 3);
  EXPECT_EQ(result(run).at("version"), 1);
  const auto records = recordings::read_library_records(LibraryPaths(library).index());
  ASSERT_TRUE(records) << records.error().message();
  ASSERT_EQ(records->size(), 3U);
  EXPECT_EQ(records->front().name, "01");
  EXPECT_EQ(records->front().frame_count(), 70);
  EXPECT_EQ(records->front().provenance.licence, "CC0-1.0");
  EXPECT_FALSE(records->front().figures.empty());
}

TEST(LibraryBuild, TheSameBytesHoweverItIsBuilt) {
  const WalkLibrary walks(5);
  const fs::path one = walks.make("one");
  const fs::path two = walks.make("other/two");
  const fs::path shards = walks.make("shards");
  ASSERT_EQ(build(one, "1").exit_code, 0);
  ASSERT_EQ(build(two, "2").exit_code, 0);
  ASSERT_EQ(library_command({"plan", shards.string(), "--shards", "3"}).exit_code, 0);
  for (const char* shard : {"2", "3", "1", "1"}) {
    const ProgramRun work =
        library_command({"work", shards.string(), "--shard", shard, "--jobs", "1"});
    EXPECT_EQ(work.exit_code, 0) << work.err;
  }
  const ProgramRun merge = library_command({"merge", shards.string()});
  ASSERT_EQ(merge.exit_code, 0) << merge.err;
  EXPECT_EQ(built_files(one), built_files(two));
  EXPECT_EQ(built_files(one), built_files(shards));
  EXPECT_FALSE(fs::exists(LibraryPaths(shards).shards()));
}

TEST(LibraryBuild, ReadsNoSourceAgainIfNothingChanged) {
  const WalkLibrary walks(3);
  const fs::path library = walks.make("library");
  ASSERT_EQ(build(library).exit_code, 0);
  const auto before = built_files(library);
  const ProgramRun again = build(library);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(result(again).at("sources_read"), 0);
  EXPECT_EQ(result(again).at("is_new_version"), false);
  EXPECT_EQ(built_files(library), before);
}

TEST(LibraryBuild, ReadsOnlyChangedSources) {
  const WalkLibrary walks(3);
  const fs::path library = walks.make("library");
  ASSERT_EQ(build(library).exit_code, 0);
  std::ofstream(walks.walk(2), std::ios::app) << "\n";
  const ProgramRun changed = build(library);
  EXPECT_EQ(changed.exit_code, 0) << changed.err;
  EXPECT_EQ(result(changed).at("sources_read"), 1);
  EXPECT_EQ(result(changed).at("version"), 2);
  const ProgramRun diff = library_command({"diff", library.string(), "1", "2", "--json"});
  const auto changes = nlohmann::json::parse(diff.out, nullptr, false);
  ASSERT_EQ(changes.size(), 1U) << diff.out;
  EXPECT_EQ(changes[0].at("name"), "02");
  EXPECT_EQ(changes[0].at("source"), true);
}

TEST(LibraryBuild, AChangedThresholdReadsNoSource) {
  const WalkLibrary walks(2);
  const fs::path library = walks.make("library");
  ASSERT_EQ(build(library).exit_code, 0);
  // Sources that cannot be read any more, with the same state: reading one would fail.
  const std::string settings = read_text(library / "library.toml");
  write_text(library / "library.toml", settings + "[quality]\nslide_cm_s = [0, 0]\n");
  for (int number : {1, 2}) fs::permissions(walks.walk(number), fs::perms::none);
  const ProgramRun run = build(library);
  for (int number : {1, 2}) fs::permissions(walks.walk(number), fs::perms::owner_all);
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(LibraryBuild, OneBadSourceCostsOnlyItself) {
  const WalkLibrary walks(2);
  write_text(walks.walks() / "broken.bvh", "HIERARCHY\nROOT hips\n{\n");
  const fs::path library = walks.make("library");
  const ProgramRun run = build(library);
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_EQ(result(run).at("clips"), 2);
  const auto failures = result(run).at("failures");
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_NE(failures[0].at("where").get<std::string>().find("broken.bvh"),
            std::string::npos);
  std::string reasons;
  for (const auto& entry : fs::recursive_directory_iterator(library / "failed")) {
    if (entry.is_regular_file()) reasons += read_text(entry.path());
  }
  EXPECT_NE(reasons.find("broken.bvh"), std::string::npos) << reasons;
  EXPECT_NE(reasons.find("Next:"), std::string::npos) << reasons;
  // The failure is remembered, and goes with its source.
  EXPECT_EQ(result(build(library)).at("sources_read"), 0);
  fs::remove(walks.walks() / "broken.bvh");
  EXPECT_EQ(build(library).exit_code, 0);
  EXPECT_FALSE(fs::exists(library / "failed"));
}

TEST(LibraryBuild, ASourceWithTheSameBytesGivesNoOtherClip) {
  const WalkLibrary walks(2);
  fs::copy_file(walks.walk(1), walks.walks() / "copy.bvh");
  const fs::path library = walks.make("library");
  const ProgramRun run = build(library);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(result(run).at("clips"), 2);
  EXPECT_NE(result(run).at("remarks").dump().find("same bytes"), std::string::npos);
}

TEST(LibraryBuild, MakesDamagedObjectsAgain) {
  const WalkLibrary walks(2);
  const fs::path library = walks.make("library");
  ASSERT_EQ(build(library).exit_code, 0);
  const auto whole = built_files(library);
  std::mt19937 random(7);
  for (const auto& [name, digest] : whole) {
    if (!name.starts_with("objects") && name != "library.sqlite") continue;
    if (name.ends_with(".npz")) {
      fs::remove(library / name);
    } else {
      fs::resize_file(library / name, random() % fs::file_size(library / name));
    }
    const ProgramRun run = build(library);
    EXPECT_EQ(run.exit_code, 0) << name << ": " << run.err;
  }
  // An index that is current hides damaged objects, until it is made again.
  fs::remove(library / "library.sqlite");
  EXPECT_EQ(build(library).exit_code, 0);
  EXPECT_EQ(built_files(library), whole);
}

TEST(LibraryBuild, NoticesAMissingOrShortMotionAlthoughTheIndexIsCurrent) {
  const WalkLibrary walks(2);
  const fs::path library = walks.make("library");
  ASSERT_EQ(build(library).exit_code, 0);
  const auto whole = built_files(library);
  for (const auto& [name, digest] : whole) {
    if (!name.ends_with(".npz") && !name.starts_with("search")) continue;
    fs::resize_file(library / name, fs::file_size(library / name) - 1);
    EXPECT_EQ(build(library).exit_code, 0) << name;
    EXPECT_EQ(built_files(library), whole) << name;
    fs::remove(library / name);
    EXPECT_EQ(build(library).exit_code, 0) << name;
    EXPECT_EQ(built_files(library), whole) << name;
  }
}

/// Changes bytes in the middle of a file, whose size stays.
void change_bytes(const fs::path& file) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
  for (int i = 0; i < 2000; ++i) stream.put(static_cast<char>(i * 37 + 11));
}

TEST(LibraryBuild, NoticesChangedBytesInTheIndexAndInSearchRows) {
  const WalkLibrary walks(4);
  const fs::path library = walks.make("library");
  ASSERT_EQ(build(library).exit_code, 0);
  const auto whole = built_files(library);
  for (const auto& [name, digest] : whole) {
    if (name != "library.sqlite" && !name.ends_with("features.f32")) continue;
    change_bytes(library / name);
    EXPECT_NE(built_files(library), whole) << name;
    const ProgramRun query = library_command({"similar", library.string(), "01"});
    // A page of the index that this query does not read hides its damage.
    if (name.ends_with(".f32")) {
      EXPECT_NE(query.exit_code, 0) << name << query.out;
    }
    EXPECT_EQ(build(library).exit_code, 0) << name;
    EXPECT_EQ(built_files(library), whole) << name;
  }
}

TEST(LibraryBuild, AnExportNeedsTheCurrentSettings) {
  const WalkLibrary walks(1);
  const fs::path library = walks.make("library");
  ASSERT_EQ(build(library).exit_code, 0);
  const std::string out = (walks.folder() / "export").string();
  const auto inside = library_command({"export",
                                       library.string(),
                                       "--as",
                                       "npz",
                                       "--to",
                                       (library / "objects" / "export").string()});
  EXPECT_EQ(inside.exit_code, 3) << inside.err;
  write_text(library / "library.toml",
             testing::replace_first(
                 read_text(library / "library.toml"), "CC0-1.0", "CC-BY-NC-4.0"));
  const std::vector<std::string> words = {
      "export", library.string(), "--as", "npz", "--to", out};
  const ProgramRun stale = library_command(words);
  EXPECT_EQ(stale.exit_code, 3) << stale.err;
  EXPECT_NE(stale.err.find("since the last build"), std::string::npos) << stale.err;
  ASSERT_EQ(build(library).exit_code, 0);
  const ProgramRun refused = library_command(words);
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_NE(refused.err.find("--allow-licence"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(out));
}

TEST(LibraryBuild, NamesSourcesThatShareFilesUnderDifferentLicences) {
  const WalkLibrary walks(2);
  const fs::path library = walks.make(
      "library",
      "[[source]]\npath = \"" + walks.walk(1).string() + "\"\nlicence = \"MIT\"\n");
  const ProgramRun run = build(library);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(result(run).at("remarks").dump().find("licences differ"), std::string::npos)
      << run.out;
}

TEST(LibraryBuild, KeepsRemarksWhileNothingChanges) {
  const WalkLibrary walks(2);
  fs::copy_file(walks.walk(1), walks.walks() / "copy.bvh");
  const fs::path library = walks.make("library");
  const ProgramRun first = build(library);
  EXPECT_FALSE(result(first).at("remarks").empty());
  EXPECT_EQ(result(build(library)).at("remarks"), result(first).at("remarks"));
}

TEST(LibraryBuild, ChecksTheNamesOfLimits) {
  const WalkLibrary walks(1);
  const ProgramRun run = build(walks.make("library", "[quality]\nslidee = [1, 2]\n"));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("slide_cm_s"), std::string::npos) << run.err;
}

TEST(LibraryBuild, LabelsOfAnotherSourceDivideNoMotion) {
  const WalkLibrary walks(2);
  fs::create_directories(walks.walks() / "other");
  fs::copy_file(walks.walk(2), walks.walks() / "other" / "01.bvh");
  const fs::path library = walks.make("library", "[segment]\nby = \"labels\"\n");
  const std::string header = "clip_or_source,start_s,end_s,label,by,sure\n";
  // "01" fits two sources, and the other name one.
  write_text(library / "labels" / "anna.csv",
             header + "01,0.2,0.6,ambiguous,,\n02,0.3,1.1,turn,,\n");
  const ProgramRun run = build(library);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto records = recordings::read_library_records(LibraryPaths(library).index());
  ASSERT_TRUE(records);
  ASSERT_EQ(records->size(), 1U);
  EXPECT_EQ(records->front().first_frame, 9);
  EXPECT_EQ(records->front().last_frame, 33);
  EXPECT_NE(result(run).at("remarks").dump().find("anna.csv"), std::string::npos);
}

TEST(LibraryBuild, TwoBuildsAtOnceDoNotMeet) {
  const WalkLibrary walks(1);
  const fs::path library = walks.make("library");
  const auto lock = LibraryPaths(library).lock();
  write_text(lock, "another-host 17 4711\n");
  const ProgramRun other = build(library);
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("another-host"), std::string::npos) << other.err;
  // A process of this host that has ended.
  std::string host(256, '\0');
  ASSERT_EQ(gethostname(host.data(), host.size()), 0);
  const std::string space = fs::read_symlink("/proc/self/ns/pid").string();
  write_text(lock, std::string(host.c_str()) + " 999999999 1 " + space + "\n");
  EXPECT_EQ(build(library).exit_code, 0);
  EXPECT_FALSE(fs::exists(lock));
}

TEST(LibraryBuild, MergeNamesUnfinishedShards) {
  const WalkLibrary walks(4);
  const fs::path library = walks.make("library");
  const ProgramRun plan =
      library_command({"plan", library.string(), "--shards", "4", "--slurm"});
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_NE(plan.out.find("sbatch"), std::string::npos) << plan.out;
  ASSERT_EQ(library_command({"work", library.string(), "--shard", "2"}).exit_code, 0);
  // Another number of shards is refused, and nothing is printed that could be run.
  const ProgramRun other =
      library_command({"plan", library.string(), "--shards", "3", "--slurm"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_TRUE(other.out.empty()) << other.out;
  const ProgramRun merge = library_command({"merge", library.string()});
  EXPECT_EQ(merge.exit_code, 3);
  EXPECT_NE(merge.err.find("1, 3, 4"), std::string::npos) << merge.err;
  // Settings that change meanwhile belong to another plan.
  write_text(library / "library.toml",
             read_text(library / "library.toml") + "[segment]\nby = \"steps\"\n");
  EXPECT_EQ(library_command({"work", library.string(), "--shard", "1"}).exit_code, 3);
}

/// Runs a build and kills it after some time.
void kill_build(const fs::path& library, std::chrono::microseconds after) {
  std::vector<std::string> words = {program(), "library", "build", library.string()};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&quiet, 2, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  ASSERT_EQ(posix_spawn(&child, arguments[0], &quiet, nullptr, arguments.data(), environ),
            0);
  posix_spawn_file_actions_destroy(&quiet);
  std::this_thread::sleep_for(after);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

TEST(LibraryBuild, AKilledBuildLeavesTheLastVersionAndGoesOn) {
  const WalkLibrary walks(6);
  const fs::path whole = walks.make("whole");
  ASSERT_EQ(build(whole).exit_code, 0);
  const fs::path library = walks.make("killed");
  std::mt19937 random(20);
  constexpr int kKills = 12;
  constexpr unsigned kMax_us = 60'000;
  for (int i = 0; i < kKills; ++i) {
    kill_build(library, std::chrono::microseconds(random() % kMax_us));
    const LibraryPaths paths(library);
    if (!fs::exists(paths.index())) continue;
    EXPECT_TRUE(recordings::read_library_records(paths.index()));
    const auto rows = recordings::search_file(paths.index(), "features.f32");
    ASSERT_TRUE(rows);
    EXPECT_TRUE(fs::exists(*rows));
  }
  EXPECT_EQ(build(library).exit_code, 0);
  EXPECT_EQ(built_files(library), built_files(whole));
}

TEST(LibraryBuild, RefusesAFolderWithoutSettings) {
  const testing::ScratchFolder folder;
  const ProgramRun run = build(folder.path());
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("library add"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace marey::app
