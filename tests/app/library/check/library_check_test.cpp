// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/library_check.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/library/check/check_json.h"
#include "app/library/check/check_text.h"
#include "recordings/base/atomic_file.h"
#include "tests/app/library/check/checked_clips.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using marey::testing::checked_clips;
using marey::testing::ScratchFolder;
using CheckedJson = nlohmann::ordered_json;

/// A clip of ten seconds at 30 Hz.
ClipRecord judged_clip(const std::string& id, std::vector<ClipFigure> figures) {
  ClipRecord clip;
  clip.clip_id = id;
  clip.name = "clip " + id;
  clip.last_frame = 300;
  clip.rate_hz = 30.0;
  clip.figures = std::move(figures);
  for (const ClipFigure& figure : clip.figures) {
    clip.quality = std::max(clip.quality, figure.verdict.value_or(Verdict::kPass));
  }
  return clip;
}

/// Clips that pass, warn, and fail in one and in two figures.
LibraryCheck four_clips() {
  const auto figure = [](const char* name, double value, Verdict verdict) {
    return ClipFigure{name, value, verdict, "", FrameRange{30, 59}};
  };
  std::vector<ClipRecord> clips = {
      judged_clip("a", {figure("slide_cm_s", 1.0, Verdict::kPass)}),
      judged_clip("b", {figure("slide_cm_s", 8.0, Verdict::kWarn)}),
      judged_clip("c", {figure("slide_cm_s", 40.0, Verdict::kFail)}),
      judged_clip("d",
                  {figure("slide_cm_s", 14.0, Verdict::kFail),
                   figure("spike", 6.0, Verdict::kFail),
                   {"speed_m_s", 1.5, std::nullopt, "", std::nullopt}})};
  clips[1].problems = {{{30, 59}, "slide", "leftFoot", 8.0}};
  clips[3].problems = {{{30, 30}, "spike", "head", 6.0},
                       {{30, 59}, "slide", "leftFoot", 14.0},
                       {{90, 119}, "slide", "leftFoot", 13.0}};
  clips[2].duplicate_of = "a";
  const QualityLimit own{"slide_cm_s", 7.0, 12.0};
  LibraryCheck check = check_library(
      std::move(clips),
      library::QualityLimits(std::span(&own, 1)),
      {{"walks/x.bvh", "walks/x.bvh:12", "it ends early", "copy it again"}});
  check.library = "walks";
  check.folder = "/data/walks";
  return check;
}

std::string text_of_check(const LibraryCheck& check, std::size_t max_clips) {
  std::string out;
  for (const std::string& line : check_lines(check, max_clips)) out += line + "\n";
  return out;
}

TEST(LibraryCheck, CountsVerdictsFiguresAndProblems) {
  const LibraryCheck check = four_clips();
  EXPECT_EQ(check.total.clips, 4);
  EXPECT_NEAR(check.total.hours, 40.0 / 3600.0, 1e-9);
  EXPECT_EQ(check.by_verdict[0].clips, 1);
  EXPECT_EQ(check.by_verdict[1].clips, 1);
  EXPECT_EQ(check.by_verdict[2].clips, 2);
  EXPECT_EQ(check.duplicates, 1);
  ASSERT_EQ(check.figures.size(), 3u);
  EXPECT_EQ(check.figures[0].figure, "spike");  // In the order of the gate.
  const FigureSummary& slide = check.figures[1];
  EXPECT_EQ(slide.figure, "slide_cm_s");
  EXPECT_EQ(slide.warn, 7.0);
  EXPECT_EQ(slide.clips, 4);
  EXPECT_EQ(slide.verdicts[1], 1);
  EXPECT_EQ(slide.verdicts[2], 2);
  EXPECT_EQ(slide.max, 40.0);
  EXPECT_EQ(slide.worst_clip, 2u);
  EXPECT_EQ(check.figures[2].figure, "speed_m_s");
  EXPECT_FALSE(check.figures[2].is_judged);
  ASSERT_EQ(check.kinds.size(), 2u);
  EXPECT_EQ(check.kinds[0].kind, "slide");
  EXPECT_EQ(check.kinds[0].clips, 2);
  EXPECT_EQ(check.kinds[0].problems, 3);
  EXPECT_NEAR(check.kinds[0].seconds, 3.0, 1e-9);
  // Two figures that fail are worse than a large value of one.
  EXPECT_EQ(check.worst_first, (std::vector<std::size_t>{3, 2, 1, 0}));
}

TEST(LibraryCheck, LimitsOfZeroAreLimits) {
  const std::vector<QualityLimit> own{{"swap_frames", 0.0, 0.0}};
  ClipRecord clip;
  clip.rate_hz = 30.0;
  clip.figures.push_back({"swap_frames", 3.0, Verdict::kFail, "", std::nullopt});
  const LibraryCheck check = check_library({clip}, library::QualityLimits(own), {});
  ASSERT_EQ(check.figures.size(), 1u);
  EXPECT_TRUE(check.figures[0].is_judged);
  EXPECT_EQ(check.figures[0].verdicts[2], 1);
}

TEST(LibraryCheck, KnowsTheUnitsOfProblems) {
  EXPECT_EQ(unit_of_kind("jitter"), " mm");
  EXPECT_EQ(unit_of_kind("tilt"), " deg");
  EXPECT_EQ(unit_of_kind("frozen"), " s");
  EXPECT_EQ(unit_of_kind("spike"), "");
  EXPECT_EQ(unit_of_kind("slide"), "") << "cm/s and mm";
  EXPECT_EQ(unit_of_kind("fit"), "") << "no figure of the gate";
}

TEST(LibraryCheck, PrintsTheWorstWithTimesAndReasons) {
  const std::string text = text_of_check(four_clips(), 2);
  for (const char* part :
       {"walks: 4 clips, 0.7 min, 1 of them duplicates",
        "  fail       2 clips   50.0 %",
        "slide_cm_s           1      2   40 (limits 7, 12) in clip c, frames 30-59 (1.00 "
        "s)",
        "slide                2      3     3.0 s",
        "  fail d clip d, 10.00 s\n    spike of head at 1.00-1.03 s: 6\n",
        "  and 1 more: see the page",
        "1 source gave no clip:\n  walks/x.bvh:12: it ends early. Next: copy it "
        "again.\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  EXPECT_EQ(text.find("speed_m_s"), std::string::npos);
}

TEST(LibraryCheck, PrintsNoControlCharactersOfNames) {
  std::vector<ClipRecord> clips = {judged_clip("a", {})};
  clips[0].name = "\x1b[2Jx";
  clips[0].quality = Verdict::kFail;
  const LibraryCheck check = check_library(clips, library::QualityLimits({}), {});
  EXPECT_EQ(text_of_check(check, 5).find('\x1b'), std::string::npos);
  EXPECT_NE(text_of_check(check, 5).find("?[2Jx"), std::string::npos);
}

TEST(LibraryCheck, DescribesAnEmptyLibrary) {
  const LibraryCheck check = check_library({}, library::QualityLimits({}), {});
  EXPECT_EQ(check.total.clips, 0);
  EXPECT_NE(text_of_check(check, 5).find("0 clips"), std::string::npos);
  const CheckedJson json = check_json(check);
  EXPECT_EQ(json["clips"].size(), 0u);
  EXPECT_EQ(json["verdicts"]["fail"]["clips"], 0);
}

TEST(LibraryCheck, HasEverythingInJson) {
  const CheckedJson json = check_json(four_clips());
  EXPECT_EQ(json["format"], 1);
  EXPECT_EQ(json["total"]["clips"], 4);
  EXPECT_EQ(json["figures"][1]["worst"]["clip"], "c");
  EXPECT_EQ(json["figures"][1]["limits"], CheckedJson({7.0, 12.0}));
  EXPECT_TRUE(json["figures"][2]["limits"].is_null());
  EXPECT_EQ(json["failed"][0]["cause"], "it ends early");
  ASSERT_EQ(json["clips"].size(), 4u);
  const CheckedJson& worst = json["clips"][0];
  EXPECT_EQ(worst["clip"], "d");
  EXPECT_EQ(worst["quality"], "fail");
  EXPECT_EQ(worst["figures"][1]["name"], "spike");
  EXPECT_EQ(worst["problems"][1]["start_s"], 1.0);
  EXPECT_EQ(worst["problems"][1]["end_s"], 2.0);
  EXPECT_FALSE(check_summary_json(four_clips()).contains("clips"));
}

TEST(LibraryCheck, JudgesAKindOfProblemByItsFigures) {
  const LibraryCheck check = four_clips();
  EXPECT_EQ(verdict_of_kind(check.clips[1], "slide"), Verdict::kWarn);
  EXPECT_EQ(verdict_of_kind(check.clips[3], "slide"), Verdict::kFail);
  EXPECT_EQ(verdict_of_kind(check.clips[3], "unknown"), Verdict::kWarn);
}

TEST(LibraryCheck, OrdersManyClipsByQuality) {
  const LibraryCheck check =
      check_library(checked_clips(3000), library::QualityLimits({}), {});
  for (std::size_t i = 1; i < check.worst_first.size(); ++i) {
    EXPECT_GE(check.clips[check.worst_first[i - 1]].quality,
              check.clips[check.worst_first[i]].quality);
  }
  EXPECT_GT(check.by_verdict[2].clips, 0);
}

TEST(ShortNumber, HasAtMostFourDigits) {
  EXPECT_EQ(short_number(0.0), "0");
  EXPECT_EQ(short_number(-0.0001), "0");
  EXPECT_EQ(short_number(0.05), "0.05");
  EXPECT_EQ(short_number(-1.256), "-1.26");
  EXPECT_EQ(short_number(12.0), "12");
  EXPECT_EQ(short_number(1234.6), "1235");
  EXPECT_EQ(short_number(1.5e6), "1.5e+06");
}

TEST(FailedSources, AreReadWithCauseAndNextStep) {
  const ScratchFolder folder;
  const auto none = read_failed_sources(folder.path());
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
  const auto write = [&](const std::string& name, const std::string& text) {
    ASSERT_TRUE(recordings::write_file(folder / "failed" / name, text));
  };
  write("walks/b.bvh.txt",
        "walks/b.bvh:7\nCause: expected 57 values, found 56.\nNext: export it again.\n");
  write("a.amc.txt", "the program ended with signal 11\x1b\n");
  write("data/c.bvh.txt", "/data/c.bvh: 3\nCause: it ends.\nNext: export it again.\n");
  write("notes.md", "no reason");
  const auto failed = read_failed_sources(folder.path());
  ASSERT_TRUE(failed);
  ASSERT_EQ(failed->size(), 3u);
  EXPECT_EQ((*failed)[0].source, "/data/c.bvh");
  EXPECT_EQ((*failed)[1].source, "a.amc");
  EXPECT_EQ((*failed)[1].cause, "the program ended with signal 11?");
  EXPECT_EQ((*failed)[1].where, "");
  EXPECT_EQ((*failed)[2].source, "walks/b.bvh");
  EXPECT_EQ((*failed)[2].where, "walks/b.bvh:7");
  EXPECT_EQ((*failed)[2].cause, "expected 57 values, found 56");
  EXPECT_EQ((*failed)[2].next, "export it again");
}

}  // namespace
}  // namespace marey::app
