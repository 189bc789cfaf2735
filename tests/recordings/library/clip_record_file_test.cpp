// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/clip_record_file.h"

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/sha256.h"

namespace marey::recordings {
namespace {

ClipRecord full_record() {
  ClipRecord record;
  record.clip_id = "0123456789abcdef";
  record.object_key = std::string(64, 'a');
  record.name = "walk \"fast\" 3";
  record.provenance = {std::string(64, 'b'),
                       "bandai/walk.bvh",
                       "bvh",
                       "CC-BY-NC-4.0",
                       "repository",
                       "74ead3b",
                       "actor1",
                       "the makers"};
  record.body = "man";
  record.first_frame = 12;
  record.last_frame = 311;
  record.rate_hz = 29.97;
  record.rate_by = RateBasis::kTable;
  record.quality = Verdict::kWarn;
  record.figures = {{"slide_cm_s", 3.75, Verdict::kWarn, "leftFoot", FrameRange{5, 9}},
                    {"sparc", -1.5, std::nullopt, "", std::nullopt}};
  record.problems = {{{5, 9}, "slide", "leftFoot", 0.1}};
  record.labels = {{0.0, 1.25, "turn left", "marey", 0.75}};
  record.events = {{3, "left.strike"}};
  record.split = "train";
  record.duplicate_of = "fedcba9876543210";
  return record;
}

TEST(ClipRecordFile, IsReadBackAsItWasWritten) {
  const std::string text = clip_record_text(full_record());
  const auto read = parse_clip_record(text, "record.json");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(clip_record_text(*read), text);
  EXPECT_EQ(read->name, "walk \"fast\" 3");
  EXPECT_EQ(read->provenance.licence, "CC-BY-NC-4.0");
  EXPECT_EQ(read->rate_by, RateBasis::kTable);
  EXPECT_EQ(read->frame_count(), 300);
  ASSERT_EQ(read->figures.size(), 2u);
  EXPECT_EQ(read->figures[0].verdict, Verdict::kWarn);
  EXPECT_EQ(read->figures[0].frames->last, 9);
  EXPECT_FALSE(read->figures[1].verdict);
  EXPECT_FALSE(read->figures[1].frames);
  EXPECT_EQ(read->labels[0].end_s, 1.25);
  EXPECT_EQ(read->events[0].name, "left.strike");
  const auto empty = parse_clip_record(clip_record_text({}), "record.json");
  ASSERT_TRUE(empty) << empty.error().message();
}

TEST(ClipRecordFile, RefusesDamageWithTheKeyAndTheNextStep) {
  struct Damage {
    std::string_view right;
    std::string_view wrong;
    std::string_view said;
  };
  const std::vector<Damage> damages = {
      {"\"format\": 1", "\"format\": 2", "another version"},
      {"\"clip_id\"", "\"clip\"", "clip_id"},
      {"29.97", "\"fast\"", "rate_hz"},
      {"\"table\"", "\"guess\"", "rate_by"},
      {"\"slide_cm_s\"", "7", "name"},
      {"{", "[", "JSON"},
  };
  const std::string text = clip_record_text(full_record());
  for (const Damage& damage : damages) {
    std::string wrong = text;
    wrong.replace(wrong.find(damage.right), damage.right.size(), damage.wrong);
    const auto read = parse_clip_record(wrong, "record.json");
    ASSERT_FALSE(read) << damage.wrong;
    EXPECT_NE(read.error().message().find(damage.said), std::string::npos)
        << read.error().message();
    EXPECT_NE(read.error().message().find("library build"), std::string::npos);
  }
  EXPECT_FALSE(parse_clip_record(std::string(100000, '['), "record.json"));
  for (std::size_t size = 0; size + 1 < text.size(); size += 7) {
    EXPECT_FALSE(parse_clip_record(text.substr(0, size), "record.json"));
  }
}

TEST(ClipRecordFile, IdsDependOnEverythingThatTheyName) {
  std::set<std::string> ids;
  for (const std::string source : {"1", "12"}) {
    for (const std::string body : {"", "2", "man"}) {
      for (const int first : {0, 1}) {
        for (const int last : {1, 11}) {
          ids.insert(clip_id_of(source, body, first, last));
        }
      }
    }
  }
  EXPECT_EQ(ids.size(), 24u);
  for (const std::string& id : ids) EXPECT_EQ(id.size(), 16u);
  EXPECT_NE(stage_key("a", "read", 1, "", ""), stage_key("a", "read", 2, "", ""));
  EXPECT_NE(stage_key("a", "read", 1, "x", ""), stage_key("a", "read", 1, "", "x"));
  EXPECT_EQ(stage_key("a", "read", 1, "x", "y"), stage_key("a", "read", 1, "x", "y"));
  const std::string key = sha256("key");
  EXPECT_EQ(object_path(key, ".npz").generic_string(),
            "objects/" + key.substr(0, 2) + "/" + key.substr(2) + ".npz");
}

}  // namespace
}  // namespace marey::recordings
