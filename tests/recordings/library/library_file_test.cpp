// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_file.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace marey::recordings {
namespace {

constexpr std::string_view kWhole = R"(format = 1
name = "walks"
skeleton = "smpl22"
rate_hz = 30
clean = "ground"

[[source]]
path = "bandai"   # kept apart
kind = "bvh"
licence = "CC-BY-NC-4.0"
origin = "repository"
commit = "74ead3b"
attribution = "the makers"
subject = "{subject}"
pattern = "dataset-{set}_{content}_{style}_{n}"
index = "table.csv"
rate_hz = 30
skip = ["*/broken/*"]

[[source]]
path = "take.npz"

[quality]
slide_cm_s = [3, 8]
spike = [4, 6]

[segment]
by = "steps"

[duplicates]
max_distance = 0.2
max_shift_s = 1
min_cover_share = 0.8

[splits]
train = 0.5
test = 0.5
)";

TEST(LibraryFile, ReadsEveryKey) {
  const auto library = parse_library(kWhole, "library.toml");
  ASSERT_TRUE(library) << library.error().message();
  EXPECT_EQ(library->name, "walks");
  EXPECT_EQ(library->skeleton, "smpl22");
  EXPECT_EQ(library->rate_hz, 30.0);
  EXPECT_EQ(library->clean, CleanBy::kGround);
  ASSERT_EQ(library->sources.size(), 2u);
  const LibrarySource& source = library->sources[0];
  EXPECT_EQ(source.path, "bandai");
  EXPECT_EQ(source.licence, "CC-BY-NC-4.0");
  EXPECT_EQ(source.pattern, "dataset-{set}_{content}_{style}_{n}");
  EXPECT_EQ(source.skip, std::vector<std::string>{"*/broken/*"});
  EXPECT_EQ(source.line, 7);
  EXPECT_EQ(library->sources[1].licence, "");
  ASSERT_EQ(library->limits.size(), 2u);
  EXPECT_EQ(library->limits[0].figure, "slide_cm_s");
  EXPECT_EQ(library->limits[0].fail, 8.0);
  EXPECT_EQ(library->segment, SegmentBy::kSteps);
  EXPECT_EQ(library->duplicates.min_cover_share, 0.8);
  EXPECT_EQ(library->splits,
            (std::vector<std::pair<std::string, double>>{{"train", 0.5}, {"test", 0.5}}));
}

TEST(LibraryFile, ReadsBackAnAddedSourceAndKeepsComments) {
  LibrarySource source = parse_library(kWhole, "library.toml")->sources[0];
  source.path = "other \"quoted\" folder";
  const std::string text = with_source(std::string(kWhole), source);
  EXPECT_EQ(text.substr(0, kWhole.size()), kWhole);
  const auto library = parse_library(text, "library.toml");
  ASSERT_TRUE(library) << library.error().message();
  ASSERT_EQ(library->sources.size(), 3u);
  LibrarySource read = library->sources[2];
  EXPECT_GT(read.line, 7);
  EXPECT_EQ(read.path, source.path);
  EXPECT_EQ(read.attribution, source.attribution);
  EXPECT_EQ(read.rate_hz, source.rate_hz);
  EXPECT_EQ(read.skip, source.skip);
}

TEST(LibraryFile, ReadsBackANewLibrary) {
  const auto library = parse_library(new_library_text("a \"name\""), "library.toml");
  ASSERT_TRUE(library) << library.error().message();
  EXPECT_EQ(library->name, "a \"name\"");
  EXPECT_TRUE(library->sources.empty());
}

/// A mistake in a line of kWhole, and words of its message.
struct Mistake {
  std::string_view right;
  std::string_view wrong;
  std::vector<std::string_view> said;
};

TEST(LibraryFile, ReportsAMistakeWithItsLineAndTheNextStep) {
  const std::vector<Mistake> mistakes = {
      {"format = 1", "format = 2", {"library.toml:1", "format 2", "update marey"}},
      {"licence = \"CC", "license = \"CC", {"library.toml:10", "license", "licence"}},
      {"by = \"steps\"", "by = \"step\"", {"step", "\"steps\""}},
      {"clean = \"ground\"", "clean = 3", {"library.toml:5", "clean"}},
      {"path = \"take.npz\"", "path = \"bandai\"", {"bandai", "twice"}},
      {"path = \"take.npz\"", "path = \"\"", {"path", "empty"}},
      {"slide_cm_s = [3, 8]", "slide_cm_s = [8, 3]", {"slide_cm_s", "WARN, FAIL"}},
      {"slide_cm_s = [3, 8]", "slide_cm_s = [8]", {"slide_cm_s"}},
      {"train = 0.5", "train = 0.6", {"add up"}},
      {"train = 0.5", "\"../x\" = 0.5", {"library.toml:36", "name of a split", "a to z"}},
      {"train = 0.5", "\"\" = 0.5", {"name of a split"}},
      {"train = 0.5", "Train = 0.5", {"name of a split"}},
      {"rate_hz = 30\nclean", "rate_hz = 0\nclean", {"rate_hz", "Hz"}},
      {"name = \"walks\"\n", "", {"name"}},
  };
  for (const Mistake& mistake : mistakes) {
    std::string text(kWhole);
    const std::size_t at = text.find(mistake.right);
    ASSERT_NE(at, std::string::npos) << mistake.right;
    text.replace(at, mistake.right.size(), mistake.wrong);
    const auto library = parse_library(text, "library.toml");
    ASSERT_FALSE(library) << mistake.wrong;
    for (const std::string_view word : mistake.said) {
      EXPECT_NE(library.error().message().find(word), std::string::npos)
          << library.error().message();
    }
  }
}

}  // namespace
}  // namespace marey::recordings
