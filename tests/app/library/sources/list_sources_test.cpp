// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/list_sources.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using Words = std::vector<std::pair<std::string, std::string>>;

LibrarySettings settings_of(std::vector<std::string> paths) {
  LibrarySettings out;
  for (std::string& path : paths) {
    LibrarySource source;
    source.path = std::move(path);
    source.line = 7;
    out.sources.push_back(std::move(source));
  }
  return out;
}

std::vector<std::string> names_of(const std::vector<SourceFile>& files) {
  std::vector<std::string> out;
  for (const SourceFile& file : files) out.push_back(file.name);
  return out;
}

TEST(ListSources, FindsFilesBelowFoldersInTheOrderOfTheirNames) {
  const testing::ScratchFolder folder;
  for (const char* name : {"b/walk.bvh",
                           "a/run.BVH",
                           "a/deep/er.glb",
                           "a/notes.txt",
                           "a/.hidden/x.bvh",
                           "a/.y.bvh",
                           "one.npz"}) {
    ASSERT_TRUE(recordings::write_file(folder / name, "x"));
  }
  const auto files =
      list_sources(folder.path(), settings_of({"b", "a", "one.npz", "a/run.BVH"}));
  ASSERT_TRUE(files) << files.error().message();
  EXPECT_EQ(
      names_of(*files),
      (std::vector<std::string>{"a/deep/er.glb", "a/run.BVH", "b/walk.bvh", "one.npz"}));
  EXPECT_EQ((*files)[1].kind, "bvh");
  EXPECT_EQ((*files)[1].source, 1u) << "it is in two sources";
  EXPECT_EQ((*files)[2].source, 0u);
  EXPECT_EQ((*files)[2].bytes, 1u);
}

TEST(ListSources, OmitsSkippedFilesAndOtherKinds) {
  const testing::ScratchFolder folder;
  for (const char* name : {"a/walk.bvh", "a/bad/walk.bvh", "a/walk.glb"}) {
    ASSERT_TRUE(recordings::write_file(folder / name, "x"));
  }
  LibrarySettings settings = settings_of({"a"});
  settings.sources[0].skip = {"*/bad/*"};
  settings.sources[0].kind = "bvh";
  const auto files = list_sources(folder.path(), settings);
  ASSERT_TRUE(files) << files.error().message();
  EXPECT_EQ(names_of(*files), std::vector<std::string>{"a/walk.bvh"});
}

TEST(ListSources, RefusesASourceWithoutFilesWithItsLine) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "a/notes.txt", "x"));
  const auto refusal = [&](const std::string& path) {
    const auto files = list_sources(folder.path(), settings_of({path}));
    return files ? std::string() : files.error().message();
  };
  EXPECT_NE(refusal("none").find("library.toml:7"), std::string::npos);
  EXPECT_NE(refusal("none").find("does not exist"), std::string::npos);
  EXPECT_NE(refusal("a").find(".bvh"), std::string::npos) << "names the kinds";
}

TEST(ListSources, ReadsWordsInNames) {
  EXPECT_EQ(
      words_in_name("dataset-1_walk_happy_007", "dataset-{set}_{content}_{style}_{n}"),
      (Words{{"set", "1"}, {"content", "walk"}, {"style", "happy"}, {"n", "007"}}));
  EXPECT_EQ(words_in_name("02_01", "{subject}_*"), (Words{{"subject", "02"}}));
  EXPECT_EQ(words_in_name("walk", "{name}"), (Words{{"name", "walk"}}));
  EXPECT_TRUE(words_in_name("walk", "run-{n}").empty());
  EXPECT_TRUE(words_in_name("run-1-2", "run-{n}-").empty());
  EXPECT_TRUE(words_in_name("run-1", "run-{n").empty());
}

}  // namespace
}  // namespace marey::app
