// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/source_stage.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace marey::recordings {
namespace {

SourceStage two_bodies() {
  SourceStage out;
  for (const char* name : {"anna", "ben"}) {
    ClipRecord& body = out.bodies.emplace_back();
    body.body = name;
    body.object_key = std::string(64, name[0]);
    body.last_frame = 99;
    body.rate_hz = 120.0;
    body.figures.push_back({"residual_mm", 3.25, {}, "", {}});
    body.labels.push_back({0.5, 1.5, "turn", "file", 1.0});
    body.events.push_back({12, "left.strike"});
    out.motion_bytes.push_back(4711);
  }
  out.remarks = {"the rate is 120 Hz by the table"};
  return out;
}

TEST(SourceStage, ReadsWhatItWrote) {
  const std::string text = source_stage_text(two_bodies());
  const auto read = parse_source_stage(text);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->bodies.size(), 2U);
  EXPECT_EQ(read->bodies[1].body, "ben");
  EXPECT_EQ(read->bodies[1].figures.front().value, 3.25);
  EXPECT_EQ(read->remarks.size(), 1U);
  EXPECT_EQ(read->motion_bytes, (std::vector<std::uint64_t>{4711, 4711}));
  EXPECT_FALSE(read->failure);
  EXPECT_EQ(source_stage_text(*read), text);
}

TEST(SourceStage, KeepsAFailure) {
  SourceStage stage;
  stage.failure = bad_input("line 7", "a number is expected", "correct the line");
  const auto read = parse_source_stage(source_stage_text(stage));
  ASSERT_TRUE(read && read->failure);
  EXPECT_EQ(read->failure->message(), stage.failure->message());
}

TEST(SourceStage, ADamagedTextIsNoStage) {
  const std::string text = source_stage_text(two_bodies());
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    EXPECT_FALSE(parse_source_stage(text.substr(0, size))) << size;
  }
  SourceStage without_size = two_bodies();
  without_size.motion_bytes.pop_back();
  EXPECT_FALSE(parse_source_stage(source_stage_text(without_size)));
  EXPECT_FALSE(parse_source_stage("[]"));
  EXPECT_FALSE(parse_source_stage(R"({"bodies": [1], "remarks": [], "failure": null})"));
}

TEST(SourceStage, RecordsInOneFile) {
  const auto records = two_bodies().bodies;
  const auto read = parse_clip_records(clip_records_text(records));
  ASSERT_TRUE(read);
  EXPECT_EQ(clip_records_text(*read), clip_records_text(records));
  EXPECT_FALSE(parse_clip_records(clip_records_text(records).substr(10)));
}

}  // namespace
}  // namespace marey::recordings
