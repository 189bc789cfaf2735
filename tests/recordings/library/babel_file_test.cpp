// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/babel_file.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace marey::recordings {
namespace {

constexpr std::string_view kBabel = R"({
 "9": {"babel_sid": 9, "url": "https://example.org/9.mp4",
  "feat_p": "CMU/CMU/02/02_01_poses.npz", "dur": 4.5,
  "seq_ann": {"babel_lid": "x", "mul_act": false, "labels": [
    {"raw_label": "walks", "proc_label": "walk", "seg_id": "s", "act_cat": ["walk"]}]},
  "frame_ann": {"babel_lid": "y", "mul_act": true, "labels": [
    {"raw_label": "stand", "proc_label": "stand", "act_cat": ["stand", "still"],
     "start_t": 0, "end_t": 0.5},
    {"raw_label": "Walks \n on", "proc_label": null, "act_cat": null, "start_t": 0.5,
     "end_t": 4.5},
    {"raw_label": null, "proc_label": "", "act_cat": [], "start_t": 1, "end_t": 2},
    {"raw_label": "b", "proc_label": "back", "act_cat": null, "start_t": 2, "end_t": 1},
    {"raw_label": "b", "proc_label": "late", "act_cat": null, "start_t": 1e9}]}},
 "10": {"feat_p": "KIT/KIT/3/kick_poses.npz", "frame_anns": null, "seq_anns": [
   {"labels": [{"raw_label": "kick", "proc_label": "kick", "act_cat": ["kick"]}]},
   {"labels": [{"raw_label": "kick", "proc_label": "kick", "act_cat": null}]}]},
 "11": {"feat_p": "a.npz", "seq_ann": null, "frame_ann": null}
})";

TEST(BabelFile, MakesLabelsOfSequencesAndTheirParts) {
  const auto read = parse_babel(kBabel, "train.json", "babel");
  ASSERT_TRUE(read) << read.error().message();
  std::string all;
  for (const LabelRow& row : read->rows) {
    all += row.target.substr(0, 3) + " " + row.text;
    if (row.start_s) all += " " + std::to_string(*row.start_s).substr(0, 3);
    if (row.end_s) all += "-" + std::to_string(*row.end_s).substr(0, 3);
    all += "\n";
    EXPECT_EQ(row.by, "babel");
  }
  EXPECT_EQ(all,
            "KIT kick\nKIT act_cat:kick\n"
            "CMU walk\nCMU act_cat:walk\n"
            "CMU stand 0.0-0.5\nCMU act_cat:stand 0.0-0.5\nCMU act_cat:still 0.0-0.5\n"
            "CMU Walks on 0.5-4.5\n");
  EXPECT_EQ(read->left_out, 3);
}

TEST(BabelFile, RefusesOtherContentWithTheSequence) {
  struct Content {
    std::string_view text;
    std::string_view said;
  };
  const std::vector<Content> contents = {
      {"", "it is not JSON"},
      {"{\"a\": ", "it is not JSON"},
      {"[1, 2]", "it is not an object of sequences"},
      {R"({"7": 3})", "t.json: sequence \"7\": it is not an object"},
      {R"({"7": {"dur": 1}})", "it has no path of a motion, \"feat_p\""},
      {R"({"7": {"feat_p": "a", "seq_ann": 1}})", "an annotation is not an object"},
      {R"({"7": {"feat_p": "a", "seq_anns": {}}})", "its annotations are not a list"},
      {R"({"7": {"feat_p": "a", "seq_ann": {"labels": 1}}})", "\"labels\" is not a list"},
      {R"({"7": {"feat_p": "a", "seq_ann": {"labels": [1]}}})", "a label is not an obj"},
      {R"({"7": {"feat_p": "a", "seq_ann": {"labels": [{"proc_label": 1}]}}})",
       "\"proc_label\" is not text"},
      {R"({"7": {"feat_p": "a", "frame_ann": {"labels": [{"start_t": "x"}]}}})",
       "\"start_t\" is not a number"},
      {R"({"7": {"feat_p": "a", "seq_ann": {"labels": [
          {"proc_label": "a", "act_cat": "b"}]}}})",
       "\"act_cat\" is not a list"}};
  for (const Content& content : contents) {
    const auto read = parse_babel(content.text, "t.json", "babel");
    ASSERT_FALSE(read) << content.text;
    EXPECT_NE(read.error().message().find(content.said), std::string::npos)
        << read.error().message();
  }
  EXPECT_FALSE(parse_babel(std::string(100'000, '['), "t.json", "babel"));
  const std::string whole(kBabel);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(parse_babel(whole.substr(0, size), "t.json", "babel")) << size;
  }
}

}  // namespace
}  // namespace marey::recordings
