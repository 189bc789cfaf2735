// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/annotations_file.h"

#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

Annotations some_annotations() {
  Annotations annotations;
  annotations.notes = {{"phase: \"swing\" é \\", -0.1, 1.0 / 3.0},
                       {"left.strike", 0.5, 0.5},
                       {"right.strike", 0.5, 0.5}};
  annotations.curves = {{"weight", {0.0, 1e-300, 1.0 / 7.0}}, {"b", {-1e21, 0.25, 3.0}}};
  return annotations;
}

std::string annotation_text(const Annotations& annotations) {
  const Result<std::string> text = annotations_text(annotations);
  EXPECT_TRUE(text) << (text ? "" : text.error().message());
  return text ? *text : "";
}

TEST(AnnotationsFile, IsReadBackExactly) {
  const Annotations written = some_annotations();
  const Result<Annotations> read = parse_annotations(annotation_text(written), "a.json");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(*read, written);
  EXPECT_EQ(annotation_text(*read), annotation_text(written));
}

TEST(AnnotationsFile, HasALineForEachNoteAndCurve) {
  Annotations annotations;
  annotations.notes = {{"a", 0.0, 1.5}};
  annotations.curves = {{"w", {0.5, -0.0}}};
  EXPECT_EQ(annotation_text(annotations),
            "{\n  \"format\": 1,\n  \"notes\": [\n"
            "    {\"text\": \"a\", \"start_s\": 0, \"end_s\": 1.5}\n  ],\n"
            "  \"curves\": [\n    {\"name\": \"w\", \"values\": [0.5, 0]}\n  ]\n}\n");
  EXPECT_EQ(annotation_text({}),
            "{\n  \"format\": 1,\n  \"notes\": [],\n  \"curves\": []\n}\n");
}

TEST(AnnotationsFile, RandomAnnotationsAreReadBack) {
  std::mt19937_64 engine(5);
  const auto number = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-40; };
  for (int i = 0; i < 300; ++i) {
    Annotations annotations;
    double start_s = 0.0;
    for (auto left = engine() % 5; left > 0; --left) {
      start_s += number();
      annotations.notes.push_back(
          {"n" + std::to_string(left), start_s, start_s + number()});
    }
    const auto frames = engine() % 6;
    for (auto left = engine() % 3; left > 0; --left) {
      ValueCurve& curve = annotations.curves.emplace_back();
      curve.name = "c" + std::to_string(left);
      for (auto k = frames; k > 0; --k) curve.values.push_back(number() - 4096.0);
    }
    const Result<Annotations> read = parse_annotations(annotation_text(annotations), "a");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(*read, annotations);
  }
}

TEST(AnnotationsFile, NotesOfOtherProgramsAreSorted) {
  const Result<Annotations> read = parse_annotations(
      R"({"curves": [], "format": 1, "notes": [
        {"text": "b", "start_s": 1, "end_s": 1}, {"text": "a", "start_s": 1, "end_s": 2},
        {"text": "c", "end_s": 0.5, "start_s": 0}]})",
      "a.json");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->notes,
            (std::vector<Annotation>{{"c", 0.0, 0.5}, {"a", 1.0, 2.0}, {"b", 1.0, 1.0}}));
}

TEST(AnnotationsFile, RefusesMistakesByTheirPlace) {
  struct Fault {
    const char* text;
    const char* message;
  };
  for (const Fault& fault : {
           Fault{"", "a.json: the file is empty."},
           Fault{"{\n\"format\": 1,\n]", "a.json:3: not valid JSON."},
           Fault{R"({"format": 1e999})", "a.json: a number is too large."},
           Fault{"[]", "a.json: it is not an object."},
           Fault{
               R"({"format": 2, "news": 1})",
               "a.json: format: the file was made by a newer marey. Next: update marey."},
           Fault{R"({"format": 0, "notes": [], "curves": []})",
                 "a.json: format: the format is not supported."},
           Fault{R"({"notes": [], "curves": []})",
                 "a.json: the key \"format\" is missing."},
           Fault{R"({"format": 1, "note": [], "curves": []})",
                 "a.json: unknown key \"note\". Next: perhaps you mean \"notes\"."},
           Fault{R"({"format": 1, "notes": {}, "curves": []})",
                 "a.json: \"notes\" is not a list."},
           Fault{R"({"format": 1, "notes": [1], "curves": []})",
                 "a.json: notes[0]: it is not an object."},
           Fault{R"({"format": 1, "notes": [{"text": 1, "start_s": 0, "end_s": 0}],
                     "curves": []})",
                 "a.json: notes[0]: \"text\" is not text in quotes."},
           Fault{R"({"format": 1, "notes": [{"text": "a", "start_s": "0", "end_s": 0}],
                     "curves": []})",
                 "a.json: notes[0].start_s: it is not a number."},
           Fault{R"({"format": 1, "notes": [{"text": "a", "start_s": 2, "end_s": 1}],
                     "curves": []})",
                 "a.json: notes[0]: the note ends before it starts."},
           Fault{R"({"format": 1, "notes": [{"text": "a\u0007", "start_s": 2,
                     "end_s": 2}], "curves": []})",
                 "a.json: notes[0]: its text \"a?\" is not one line of text."},
           Fault{R"({"format": 1, "notes": [],
                     "curves": [{"name": "a", "values": [1, null]}]})",
                 "a.json: curves[0]: it is not a number."},
           Fault{R"({"format": 1, "notes": [], "curves": [
                     {"name": "a", "values": [1]}, {"name": "a", "values": [1]}]})",
                 "a.json: curves[1]: another curve has the name \"a\"."},
           Fault{R"({"format": 1, "notes": [], "curves": [
                     {"name": "a", "values": [1]}, {"name": "b", "values": []}]})",
                 "a.json: curves[1]: it has 0 values, and the first curve has 1."},
       }) {
    const Result<Annotations> read = parse_annotations(fault.text, "a.json");
    ASSERT_FALSE(read) << fault.text;
    EXPECT_EQ(read.error().code, Errc::kBadInput);
    EXPECT_FALSE(read.error().next.empty());
    EXPECT_TRUE(read.error().message().starts_with(fault.message))
        << read.error().message();
  }
  const std::string deep(5000, '[');
  EXPECT_FALSE(parse_annotations(deep, "a.json"));
}

TEST(AnnotationsFile, RefusesWhatCouldNotBeReadBack) {
  const testing::ScratchFolder folder;
  const auto path = folder / "a.annotations.json";
  ASSERT_TRUE(write_annotations(path, some_annotations()));
  const std::string before = testing::read_text(path);
  Annotations wrong = some_annotations();
  wrong.curves[1].values[2] = std::numeric_limits<double>::quiet_NaN();
  Status written = write_annotations(path, wrong);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().where, path.string() + ": curves[1]");
  wrong = some_annotations();
  wrong.notes[1].text = "a\xff";
  written = write_annotations(path, wrong);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().where, path.string() + ": notes[1]");
  EXPECT_EQ(testing::read_text(path), before);
  const Result<Annotations> read = read_annotations(path);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, some_annotations());
}

}  // namespace
}  // namespace marey::recordings
