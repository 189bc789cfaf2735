// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/source_id.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/base/sha256.h"
#include "tests/app/library/sources/source_scene.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::source_at;

IdentifiedSource identified(const fs::path& path) {
  const auto out = identify_source(source_at(path));
  EXPECT_TRUE(out) << out.error().message();
  return out ? *out : IdentifiedSource{};
}

std::vector<std::string> names_of(const std::vector<fs::path>& files) {
  std::vector<std::string> out;
  for (const fs::path& file : files) out.push_back(file.filename().string());
  return out;
}

/// Writes files with the text "x", unless stated.
void put(const testing::ScratchFolder& folder,
         const std::string& name,
         const std::string& text = "x") {
  ASSERT_TRUE(recordings::write_file(folder / name, text));
}

TEST(SourceId, IsTheHashOfASingleFile) {
  const testing::ScratchFolder folder;
  put(folder, "a/x.bvh", "some text");
  put(folder, "b/y.bvh", "some text");
  const IdentifiedSource source = identified(folder / "a/x.bvh");
  EXPECT_EQ(source.id, recordings::sha256("some text"));
  EXPECT_EQ(identified(folder / "b/y.bvh").id, source.id) << "a copy";
  EXPECT_EQ(names_of(source.parts.files), std::vector<std::string>{"x.bvh"});
  EXPECT_EQ(names_of(source.parts.absent), std::vector<std::string>{"x.bones.toml"});
  put(folder, "a/x.bones.toml");
  const IdentifiedSource mapped = identified(folder / "a/x.bvh");
  EXPECT_NE(mapped.id, source.id);
  EXPECT_EQ(mapped.parts.files.size(), 2u);
  EXPECT_TRUE(mapped.parts.absent.empty());
}

TEST(SourceId, ContainsTheSkeletonOfAnAmc) {
  const testing::ScratchFolder folder;
  put(folder, "02_01.amc", "motion");
  const IdentifiedSource alone = identified(folder / "02_01.amc");
  EXPECT_EQ(alone.id, recordings::sha256("motion"));
  put(folder, "02.asf", "one");
  const IdentifiedSource with = identified(folder / "02_01.amc");
  EXPECT_EQ(names_of(with.parts.files),
            (std::vector<std::string>{"02_01.amc", "02.asf"}));
  EXPECT_EQ(names_of(with.parts.absent),
            (std::vector<std::string>{"02_01.asf", "02_01.bones.toml"}));
  EXPECT_NE(with.id, alone.id);
  put(folder, "02.asf", "two");
  EXPECT_NE(identified(folder / "02_01.amc").id, with.id);
}

TEST(SourceId, ContainsTheBuffersOfAGltf) {
  const testing::ScratchFolder folder;
  put(folder,
      "a.gltf",
      R"({"buffers": [{"uri": "a%20b.bin"}, {"uri": "data:,x"}, {"uri": "no.bin"}, 5]})");
  put(folder, "a b.bin", "one");
  const IdentifiedSource one = identified(folder / "a.gltf");
  EXPECT_EQ(names_of(one.parts.files), (std::vector<std::string>{"a.gltf", "a b.bin"}));
  EXPECT_EQ(names_of(one.parts.absent),
            (std::vector<std::string>{"a.bones.toml", "no.bin"}));
  put(folder, "a b.bin", "two");
  EXPECT_NE(identified(folder / "a.gltf").id, one.id);
  for (const char* text : {"", "{", "[]", "glTF", "{\"buffers\": 3}"}) {
    put(folder, "b.glb", text);
    EXPECT_EQ(identified(folder / "b.glb").id, recordings::sha256(text)) << text;
  }
}

TEST(SourceId, ContainsSubjectAndLabelsOfMarkers) {
  const testing::ScratchFolder folder;
  put(folder, "a.c3d");
  const IdentifiedSource alone = identified(folder / "a.c3d");
  EXPECT_EQ(names_of(alone.parts.absent),
            (std::vector<std::string>{"markers.toml", "subject.toml"}));
  put(folder, "subject.toml");
  const IdentifiedSource with = identified(folder / "a.c3d");
  EXPECT_NE(with.id, alone.id);
  EXPECT_EQ(names_of(with.parts.files),
            (std::vector<std::string>{"a.c3d", "subject.toml"}));
}

TEST(SourceId, ContainsTheSourcesOfARecipe) {
  const testing::ScratchFolder folder;
  put(folder, "walk.bvh", "one");
  const std::string recipe =
      "format = 1\n[[source]]\npath = \"NAME\"\n[[op]]\ndo = \"mirror@1\"\n";
  put(folder, "a.edit.toml", testing::replace_first(recipe, "NAME", "walk.bvh"));
  put(folder, "b.edit.toml", testing::replace_first(recipe, "NAME", "a.edit.toml"));
  put(folder, "c.edit.toml", testing::replace_first(recipe, "NAME", "c.edit.toml"));
  const IdentifiedSource a = identified(folder / "a.edit.toml");
  EXPECT_EQ(names_of(a.parts.files),
            (std::vector<std::string>{"a.edit.toml", "walk.bvh"}));
  const IdentifiedSource b = identified(folder / "b.edit.toml");
  EXPECT_EQ(b.parts.files.size(), 3u);
  EXPECT_GT(identified(folder / "c.edit.toml").parts.files.size(), 1u)
      << "its own source";
  put(folder, "walk.bvh", "two");
  EXPECT_NE(identified(folder / "a.edit.toml").id, a.id);
  EXPECT_NE(identified(folder / "b.edit.toml").id, b.id);
}

TEST(SourceId, ContainsTheVideosOfASession) {
  const testing::ScratchFolder folder;
  const auto options = fs::copy_options::recursive;
  fs::copy(testing::sample_session(), folder / "one", options);
  fs::copy(testing::sample_session(), folder / "two", options);
  const IdentifiedSource one = identified(folder / "one");
  EXPECT_EQ(identified(folder / "two").id, one.id);
  EXPECT_EQ(one.parts.files.front(), folder / "one/session.toml");
  EXPECT_GT(one.parts.files.size(), 10u);
  const fs::path video = one.parts.files.back();
  const std::string bytes = testing::read_text(video);
  ASSERT_TRUE(recordings::write_file(video, bytes + "x"));
  EXPECT_NE(identified(folder / "one").id, one.id);
}

TEST(SourceId, NamesAFileThatCannotBeRead) {
  const auto missing = identify_source(source_at("none/x.bvh"));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message().find("none/x.bvh"), std::string::npos);
}

}  // namespace
}  // namespace marey::app
