// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/source_cache.h"

#include <chrono>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// A file that has not changed for an hour.
SourceFile settled_file(const fs::path& path, const std::string& text) {
  EXPECT_TRUE(recordings::write_file(path, text));
  fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(1));
  SourceFile file;
  file.path = path;
  file.name = path.filename().string();
  file.kind = "bvh";
  return file;
}

TEST(SourceCache, KnowsAFileUntilItChanges) {
  const testing::ScratchFolder library;
  const SourceFile file = settled_file(library / "a walk.bvh", "HIERARCHY");
  const auto known = know_source(file);
  ASSERT_TRUE(known) << known.error().message();
  SourceCache cache = SourceCache::read(library.path());
  cache.add(file.path, *known);
  ASSERT_TRUE(cache.write(library.path()));
  SourceCache again = SourceCache::read(library.path());
  ASSERT_NE(again.find(file.path), nullptr);
  EXPECT_EQ(again.find(file.path)->id, known->id);
  settled_file(file.path, "hierarchy");
  EXPECT_EQ(again.find(file.path), nullptr);
  fs::remove(file.path);
  EXPECT_EQ(again.find(file.path), nullptr);
}

TEST(SourceCache, DoesNotTrustAFileThatChangedJustNow) {
  const testing::ScratchFolder library;
  const SourceFile file = settled_file(library / "walk.bvh", "HIERARCHY");
  fs::last_write_time(file.path, fs::file_time_type::clock::now());
  const auto known = know_source(file);
  ASSERT_TRUE(known);
  SourceCache cache = SourceCache::read(library.path());
  cache.add(file.path, *known);
  EXPECT_EQ(cache.find(file.path), nullptr);
}

TEST(SourceCache, SeesAFileThatAppears) {
  const testing::ScratchFolder library;
  const SourceFile file = settled_file(library / "walk.bvh", "HIERARCHY");
  const auto known = know_source(file);
  ASSERT_TRUE(known);
  ASSERT_FALSE(known->absent.empty()) << "a bone map next to it would be used";
  EXPECT_TRUE(known->is_current());
  ASSERT_TRUE(recordings::write_file(known->absent.front(), "x"));
  EXPECT_FALSE(known->is_current());
}

TEST(SourceCache, ADamagedFileIsEmpty) {
  const testing::ScratchFolder library;
  const SourceFile file = settled_file(library / "walk.bvh", "HIERARCHY");
  ASSERT_TRUE(recordings::write_file(library.path() / ".cache" / "sources.jsonl",
                                     file.path.string() + "\n{\"id\": 7}\n\n[[["));
  EXPECT_EQ(SourceCache::read(library.path()).find(file.path), nullptr);
}

}  // namespace
}  // namespace marey::app
