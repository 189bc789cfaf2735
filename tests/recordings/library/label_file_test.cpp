// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/label_file.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/library/verdict_file.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::read_text;
using testing::ScratchFolder;

constexpr std::string_view kLabelHeader = "clip_or_source,start_s,end_s,label,by,sure\n";
constexpr std::string_view kVerdictHeader = "clip,figure,frames,verdict,by,note\n";

TEST(LabelFile, IsReadBackAsItWasWritten) {
  const std::vector<LabelRow> rows = {
      {"0123456789abcdef", 0.0, 1.25, "turn, to the \"left\"", "anna", 0.75},
      {"bandai/walk 1,2.bvh", std::nullopt, std::nullopt, "marche à pied", "bo", 1.0},
      {"walk.bvh", 0.1, std::nullopt, "walk", "anna", 0.0}};
  const std::string text = labels_text(rows);
  const auto read = parse_labels(text, "anna.csv", "nobody");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), rows.size());
  EXPECT_EQ((*read)[0].text, "turn, to the \"left\"");
  EXPECT_EQ((*read)[0].end_s, 1.25);
  EXPECT_EQ((*read)[1].target, "bandai/walk 1,2.bvh");
  EXPECT_FALSE((*read)[1].start_s);
  EXPECT_EQ((*read)[2].start_s, 0.1);
  EXPECT_EQ((*read)[2].certainty, 0.0);
  EXPECT_EQ((*read)[2].line, 4);
  EXPECT_EQ(labels_text(*read), text);
}

TEST(LabelFile, ReadsTablesOfOtherPrograms) {
  const std::string text =
      "\xEF\xBB\xBF"
      "clip_or_source,start_s,end_s,label,by,sure\r\n"
      "\"walk.bvh\", 0 , 2,\"walk\",,\r\n"
      "\r\n";
  const auto read = parse_labels(text, "anna.csv", "anna");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), 1u);
  EXPECT_EQ((*read)[0].target, "walk.bvh");
  EXPECT_EQ((*read)[0].end_s, 2.0);
  EXPECT_EQ((*read)[0].by, "anna");
  EXPECT_EQ((*read)[0].certainty, 1.0);
}

TEST(LabelFile, RefusesMistakesWithLineAndColumn) {
  struct Mistake {
    std::string_view text;
    std::string_view said;
  };
  const std::string header(kLabelHeader);
  const std::vector<Mistake> mistakes = {
      {"", "a.csv: the table is empty. Next: write the first line as clip_or_source,"},
      {"clip,start_s\n", "a.csv:1: the first line \"clip,start_s\" is not"},
      {"clip_or_source;start_s;end_s;label;by;sure\n", "commas between the cells"},
      {"ROWSa,0,1,walk,b\n", "a.csv:2: the number of cells is 5, not 6"},
      {"ROWSa,0,1,walk, slow,b,1\n", "put texts that have a comma into quotes"},
      {"ROWS,0,1,walk,b,1\n", "a.csv:2:1: \"clip_or_source\" is empty"},
      {"ROWSa,zero,1,walk,b,1\n", "a.csv:2:3: \"start_s\" is \"zero\", which is not a"},
      {"ROWSa,-1,1,walk,b,1\n", "a.csv:2:3: \"start_s\" is \"-1\", which is out of its"},
      {"ROWSa,0,nan,walk,b,1\n", "a.csv:2:5: \"end_s\" is \"nan\""},
      {"ROWSa,2,1,walk,b,1\n", "a.csv:2:5: the label ends before it starts"},
      {"ROWSa,0,1,,b,1\n", "a.csv:2:7: \"label\" is empty"},
      {"ROWSa,0,1,walk,b,1.5\n", "a.csv:2:14: \"sure\" is \"1.5\", which is out of its"},
      {"ROWSa,0,1,walk,marey,1\n", "a.csv:2:12: \"marey\" is the name of labels"},
      {"ROWSa,0,1,\"walk,b,1\n", "a.csv:2:7: a quote is not closed"},
      {"ROWSa,0,1,\"walk\"s,b,1\n", "a.csv:2:13: a quote is not closed, or text"},
      {"ROWSa,0,1,walk,b,1\na,0,1,w\xFFlk,b,1\n", "a.csv:3:7: the cell has bytes"},
      {"ROWSa,0,1,w\tlk,b,1\n", "a.csv:2:7: the cell has bytes that are no text"}};
  for (const Mistake& mistake : mistakes) {
    std::string text(mistake.text);
    if (text.starts_with("ROWS")) text.replace(0, 4, header);
    const auto read = parse_labels(text, "a.csv", "anna");
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().message().find(mistake.said), std::string::npos)
        << read.error().message();
    EXPECT_FALSE(read.error().next.empty());
  }
}

TEST(LabelFile, EndsAtEveryCutWithoutACrash) {
  const std::string whole = std::string(kLabelHeader) + "a,0,1,\"wa\"\"lk\",b,0.5\n";
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const auto read = parse_labels(whole.substr(0, size), "a.csv", "anna");
    EXPECT_TRUE(!read || read->size() <= 1u);
  }
}

TEST(VerdictFile, IsReadBackAsItWasWritten) {
  const std::vector<VerdictCorrection> rows = {
      {"0123456789abcdef", "slide_cm_s", FrameRange{3, 40}, Verdict::kPass, "anna", "ok"},
      {"0123456789abcdef",
       "quality",
       std::nullopt,
       Verdict::kFail,
       "",
       "prop, \"moved\""}};
  const std::string text = verdicts_text(rows);
  const auto read = parse_verdicts(text, "verdicts.csv");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), 2u);
  EXPECT_EQ((*read)[0].frames->last, 40);
  EXPECT_FALSE((*read)[1].frames);
  EXPECT_EQ((*read)[1].verdict, Verdict::kFail);
  EXPECT_EQ((*read)[1].note, "prop, \"moved\"");
  EXPECT_EQ(verdicts_text(*read), text);
  const auto one =
      parse_verdicts(std::string(kVerdictHeader) + "a,spike,7,warn,,\n", "v");
  ASSERT_TRUE(one) << one.error().message();
  EXPECT_EQ(one->front().frames->first, 7);
  EXPECT_EQ(one->front().frames->last, 7);
}

TEST(VerdictFile, RefusesMistakesWithLineAndColumn) {
  const std::string header(kVerdictHeader);
  const auto said = [&](const std::string& rows) {
    const auto read = parse_verdicts(header + rows, "v.csv");
    return read ? std::string("no error") : read.error().message();
  };
  EXPECT_NE(said("a,spike,40-3,pass,,\n").find("v.csv:2:9: \"frames\" is \"40-3\""),
            std::string::npos);
  EXPECT_NE(said("a,spike,-3,pass,,\n").find("v.csv:2:9:"), std::string::npos);
  EXPECT_NE(said("a,spike,1-99999999999,pass,,\n").find("v.csv:2:9:"), std::string::npos);
  EXPECT_NE(said("a,spike,,good,,\n").find("write pass, warn or fail"),
            std::string::npos);
  EXPECT_NE(said("a,,,pass,,\n").find("\"figure\" is empty"), std::string::npos);
}

TEST(VerdictFile, GrowsByOneLineAndKeepsATableWithAMistake) {
  const ScratchFolder folder;
  const auto file = folder / "labels" / "verdicts.csv";
  VerdictCorrection row{
      "a", "spike", FrameRange{1, 2}, Verdict::kPass, "bo", "two\nlines"};
  ASSERT_TRUE(add_verdict(file, row));
  ASSERT_TRUE(add_verdict(file, row));
  const std::string text = read_text(file);
  EXPECT_EQ(text,
            std::string(kVerdictHeader) +
                "a,spike,1-2,pass,bo,two lines\n"
                "a,spike,1-2,pass,bo,two lines\n");
  std::ofstream(file, std::ios::app) << "broken\n";
  EXPECT_FALSE(add_verdict(file, row));
  EXPECT_EQ(read_text(file), text + "broken\n");
}

}  // namespace
}  // namespace marey::recordings
