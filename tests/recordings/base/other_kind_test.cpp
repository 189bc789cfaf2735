// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/other_kind.h"

#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/base/toml_reader.h"
#include "tests/support/program/paths.h"

namespace marey::recordings {
namespace {

std::string content_of_sample(const std::string& name) {
  const auto content = read_file(testing::source_dir() / "recordings/samples" / name);
  return content ? *content : "";
}

TEST(OtherKind, NamesRealFilesOfOtherKinds) {
  EXPECT_EQ(other_kind(content_of_sample("first-light/walk/cam0.mp4")), "a video");
  EXPECT_EQ(other_kind("glTF\2"), "a glTF or VRM file");
  EXPECT_EQ(other_kind("HIERARCHY\nROOT hips\n"), "a BVH motion");
  EXPECT_EQ(other_kind("<?xml version=\"1.0\"?>"), "an XML or HTML file");
  EXPECT_EQ(other_kind("{\"asset\": {}}"), "a JSON file");
  EXPECT_EQ(other_kind(std::string("\2\x50") + std::string(600, '\0')),
            "a C3D file of markers");
  EXPECT_EQ(other_kind(std::string("a\0b", 3)), "a binary file");
}

TEST(OtherKind, IsEmptyForEveryTomlFileOfTheSamples) {
  EXPECT_EQ(other_kind(content_of_sample("first-light/session.toml")), "");
  EXPECT_EQ(other_kind(""), "");
  EXPECT_EQ(other_kind("P = 1"), "");
  EXPECT_EQ(other_kind("\xEF\xBB\xBF"
                       "format = 1"),
            "");
}

TEST(OtherKind, IsTheCauseOfATomlReadersError) {
  const auto document = parse_toml(
      content_of_sample("first-light/walk/cam0.mp4"), "cam0.mp4", "session.md");
  ASSERT_FALSE(document);
  EXPECT_EQ(document.error().message(),
            "cam0.mp4: this is a video, not a TOML file. Next: give a .toml file as "
            "docs/formats/session.md describes it.");
}

}  // namespace
}  // namespace marey::recordings
