// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/list_sources.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/library/sources/source_kind.h"
#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
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
      names_of(files->files),
      (std::vector<std::string>{"a/deep/er.glb", "a/run.BVH", "b/walk.bvh", "one.npz"}));
  EXPECT_EQ(files->files[1].kind, "bvh");
  EXPECT_EQ(files->files[1].source, 1u) << "it is in two sources";
  EXPECT_EQ(files->files[2].source, 0u);
  EXPECT_EQ(files->files[2].bytes, 1u);
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
  EXPECT_EQ(names_of(files->files), std::vector<std::string>{"a/walk.bvh"});
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

TEST(ListSources, CountsFilesOfOtherKinds) {
  const testing::ScratchFolder folder;
  for (const char* name : {"a/x.bvh",
                           "a/x.bones.toml",
                           "a/x.asf",
                           "a/n.txt",
                           "a/m.txt",
                           "a/p.PNG",
                           "a/none"}) {
    ASSERT_TRUE(recordings::write_file(folder / name, "x"));
  }
  const auto files = list_sources(folder.path(), settings_of({"a"}));
  ASSERT_TRUE(files) << files.error().message();
  EXPECT_EQ(files->left_out_text(),
            "4 files of other kinds were left out: 1 without extension, 1 .png, 2 .txt");
  EXPECT_EQ(SourceListing{}.left_out_text(), "");
}

TEST(ListSources, StatesFoldersWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root reads all folders";
  const testing::ScratchFolder folder;
  for (const char* name : {"a/x.bvh", "a/c/y.bvh", "a/b/z.bvh"}) {
    ASSERT_TRUE(recordings::write_file(folder / name, "x"));
  }
  fs::permissions(folder / "a/b", fs::perms::none);
  const auto one = list_sources(folder.path(), settings_of({"a"}));
  const auto none = list_sources(folder.path(), settings_of({"a/b"}));
  fs::permissions(folder / "a/c", fs::perms::none);
  const auto two = list_sources(folder.path(), settings_of({"a"}));
  fs::permissions(folder / "a/b", fs::perms::owner_all);
  fs::permissions(folder / "a/c", fs::perms::owner_all);
  ASSERT_TRUE(one) << one.error().message();
  EXPECT_EQ(names_of(one->files), (std::vector<std::string>{"a/c/y.bvh", "a/x.bvh"}));
  EXPECT_EQ(one->left_out_text(), "1 folder without permission was left out: a/b");
  ASSERT_TRUE(two) << two.error().message();
  EXPECT_EQ(two->left_out_text(),
            "2 folders without permission were left out, the first is a/b");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().cause.find("without permission"), std::string::npos);
}

// Too few file descriptors: the second folder cannot be opened.
TEST(ListSources, RefusesAFolderThatCannotBeListed) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "a/b/x.bvh", "x"));
  const int next = ::dup(0);
  ASSERT_GE(next, 0);
  ::close(next);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit few = before;
  few.rlim_cur = static_cast<rlim_t>(next) + 1;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  const auto files = list_sources(folder.path(), settings_of({"a"}));
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().code, Errc::kDevice);
  EXPECT_EQ(files.error().where, (folder / "a/b").string());
  EXPECT_NE(files.error().cause.find("cannot be listed"), std::string::npos);
}

TEST(ListSources, NamesSourcesWithoutTheirEndings) {
  EXPECT_EQ(source_stem("a/walk.bvh", "bvh"), "walk");
  EXPECT_EQ(source_stem("a/walk.2.bvh", "bvh"), "walk.2");
  EXPECT_EQ(source_stem("a/walk.edit.toml", kRecipeKind), "walk");
  EXPECT_EQ(source_stem("a.b/take.2", kSessionKind), "take.2");
}

TEST(ListSources, TakesASessionAsOneSource) {
  const testing::ScratchFolder folder;
  for (const char* name :
       {"s/session.toml", "s/walk/markers.c3d", "s/walk/motion.npz", "run.trc"}) {
    ASSERT_TRUE(recordings::write_file(folder / name, "1234"));
  }
  const auto files = list_sources(folder.path(), settings_of({"."}));
  ASSERT_TRUE(files) << files.error().message();
  EXPECT_EQ(names_of(files->files), (std::vector<std::string>{"run.trc", "s"}));
  EXPECT_EQ(files->files[1].kind, "session");
  EXPECT_EQ(files->files[1].bytes, 12u);
  for (const char* path : {"s", "s/session.toml"}) {
    const auto one = list_sources(folder.path(), settings_of({path}));
    ASSERT_TRUE(one) << one.error().message();
    EXPECT_EQ(names_of(one->files), std::vector<std::string>{"s"});
  }
  LibrarySettings settings = settings_of({"s"});
  settings.sources[0].kind = "c3d";
  const auto inside = list_sources(folder.path(), settings);
  ASSERT_TRUE(inside) << inside.error().message();
  EXPECT_EQ(names_of(inside->files), std::vector<std::string>{"s/walk/markers.c3d"});
}

TEST(ListSources, NeverListsWhatABuildWrites) {
  const testing::ScratchFolder folder;
  for (const char* name : {"library.toml",
                           "objects/ab/cd.npz",
                           "failed/x.bvh",
                           "a.bvh",
                           "other/library.toml",
                           "other/objects/ab/cd.npz",
                           "plain/objects/b.bvh"}) {
    ASSERT_TRUE(recordings::write_file(folder / name, "x"));
  }
  const auto files = list_sources(folder.path(), settings_of({"."}));
  ASSERT_TRUE(files) << files.error().message();
  EXPECT_EQ(names_of(files->files),
            (std::vector<std::string>{"a.bvh", "plain/objects/b.bvh"}));
  const auto own = list_sources(folder.path(), settings_of({"objects"}));
  ASSERT_FALSE(own);
  EXPECT_NE(own.error().cause.find("its build writes"), std::string::npos);
  const auto others = list_sources(folder.path(), settings_of({"other/objects"}));
  EXPECT_TRUE(others) << "motion objects of another library are sources";
}

TEST(ListSources, RefusesAnUnknownKind) {
  const testing::ScratchFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "a.bvh", "x"));
  LibrarySettings settings = settings_of({"."});
  settings.sources[0].kind = "bvhs";
  const auto files = list_sources(folder.path(), settings);
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message().find("library.toml:7"), std::string::npos);
  EXPECT_NE(files.error().next.find("recipe"), std::string::npos);
}

TEST(ListSources, FindsSubjectAndLabelsInNames) {
  SourceFile file;
  file.name = "cmu/02_01.amc";
  file.kind = "amc";
  LibrarySource source;
  EXPECT_EQ(subject_of(file, source), "");
  source.subject = "Ann";
  EXPECT_EQ(subject_of(file, source), "Ann");
  source.subject = "{subject}_*";
  EXPECT_EQ(subject_of(file, source), "02");
  source.subject = "";
  source.pattern = "{subject}_{trial}.amc";
  EXPECT_EQ(subject_of(file, source), "02") << "with its extension";
  const auto labels = labels_of_name(file, source, 2.5);
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_EQ(labels[0].text, "trial:01");
  EXPECT_EQ(labels[0].by, "name");
  EXPECT_EQ(labels[0].end_s, 2.5);
  source.pattern = "run-{n}";
  EXPECT_TRUE(labels_of_name(file, source, 2.5).empty());
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
