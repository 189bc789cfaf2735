// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/apply_labels.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/library/labels/apply_verdicts.h"
#include "app/library/labels/label_targets.h"
#include "recordings/base/atomic_file.h"
#include "tests/app/library/labels/library_records.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using marey::testing::made_clip;
using marey::testing::ScratchFolder;
using recordings::LabelRow;
using recordings::VerdictCorrection;

/// Labels as "start-end text", in order.
std::string words_of(const ClipRecord& clip) {
  std::string out;
  for (const ClipLabel& label : clip.labels) {
    out += std::to_string(label.start_s).substr(0, 4) + "-" +
           std::to_string(label.end_s).substr(0, 4) + " " + label.text + "; ";
  }
  return out;
}

TEST(LabelTargets, FindClipsSourcesAndNamesWithoutAGuess) {
  const std::vector<ClipRecord> records = {
      made_clip("amass/CMU/02/02_01_poses.npz", 0, 9),
      made_clip("cmu/amc/02/02_01.amc", 0, 9),
      made_clip("walks/a/walk.bvh", 0, 9),
      made_clip("walks/a/walk.bvh", 10, 19),
      made_clip("walks/b/walk.bvh", 0, 9),
      made_clip("walks/b/take.2.bvh", 0, 9),
      made_clip("top.bvh", 0, 9)};
  const LabelTargets targets(records);
  const auto name = [&](const std::string& text) {
    const LabelTarget target = targets.find(text);
    if (target.kind == LabelTarget::Kind::kAmbiguous) return std::string("ambiguous");
    return target.is_found() ? target.name : std::string("unknown");
  };
  EXPECT_EQ(targets.find(records[3].clip_id).kind, LabelTarget::Kind::kClip);
  EXPECT_EQ(targets.find(records[3].clip_id).clips, std::vector<std::size_t>{3});
  EXPECT_EQ(targets.find("walks/a/walk.bvh").clips, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(name("walk"), "ambiguous");
  EXPECT_EQ(name("walk.bvh"), "ambiguous");
  EXPECT_EQ(name("b/walk"), "walks/b/walk.bvh");
  EXPECT_EQ(name("./a/walk.bvh"), "walks/a/walk.bvh");
  EXPECT_EQ(name("c/walk.bvh"), "unknown");
  EXPECT_EQ(name("take.2"), "walks/b/take.2.bvh");
  EXPECT_EQ(name("take"), "unknown");
  EXPECT_EQ(name("elsewhere/top.bvh"), "top.bvh");
  EXPECT_EQ(name("CMU/CMU/02/02_01_poses.npz"), "amass/CMU/02/02_01_poses.npz");
  EXPECT_EQ(name("02_01.amc"), "cmu/amc/02/02_01.amc");
  EXPECT_EQ(name("02_01"), "ambiguous");
  EXPECT_EQ(name("KIT/KIT/3/02_01_poses.npz"), "unknown");
  EXPECT_EQ(name(""), "unknown");
  EXPECT_EQ(name("/"), "unknown");
}

TEST(ApplyLabels, CutsLabelsOfASourceToItsSegments) {
  // Seconds 0 to 2 and 2 to 4 of the source.
  std::vector<ClipRecord> records = {made_clip("walk.bvh", 0, 60),
                                     made_clip("walk.bvh", 60, 120)};
  LibraryLabels labels;
  labels.files = {{"labels/anna.csv",
                   {{"walk.bvh", 1.5, 3.0, "turn", "anna", 1.0, 2},
                    {"walk.bvh", std::nullopt, std::nullopt, "walk", "anna", 1.0, 3},
                    {"walk", 2.5, 2.5, "clap", "anna", 0.5, 4},
                    {"walk", 0.0, 2.0, "first", "anna", 1.0, 5},
                    {"walk", 9.0, 10.0, "late", "anna", 1.0, 6},
                    {records[1].clip_id, 1.0, 99.0, "end", "bo", 1.0, 7},
                    {"run", 1.0, 2.0, "run", "bo", 1.0, 8}}}};
  const auto unused = apply_labels(labels, records);
  EXPECT_EQ(words_of(records[0]), "0.00-2.00 first; 0.00-2.00 walk; 1.50-2.00 turn; ");
  EXPECT_EQ(words_of(records[1]),
            "0.00-1.00 turn; 0.00-2.00 walk; 0.50-0.50 clap; 1.00-2.00 end; ");
  EXPECT_EQ(records[1].labels[2].certainty, 0.5);
  EXPECT_EQ(records[1].labels[3].by, "bo");
  ASSERT_EQ(unused.size(), 2u);
  EXPECT_EQ(unused[0].line, 6);
  EXPECT_EQ(unused[0].cause, "its times are outside \"walk\"");
  EXPECT_EQ(unused[1].cause, "no clip or source is named \"run\"");
  const auto findings = unused_label_findings(unused);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].where, "labels/anna.csv:6");
  EXPECT_NE(findings[0].cause.find("; 1 other lines"), std::string::npos);
  // A second time, nothing is added.
  const std::string once = words_of(records[1]);
  EXPECT_EQ(apply_labels(labels, records).size(), 2u);
  EXPECT_EQ(words_of(records[1]), once);
}

TEST(ApplyLabels, KeepsLabelsOfMareyAndTheirOrder) {
  std::vector<ClipRecord> records = {made_clip("walk.bvh", 0, 60)};
  records[0].labels = {{0.0, 1.0, "moving", "marey", 1.0},
                       {1.0, 2.0, "crouched", "marey", 1.0}};
  LibraryLabels labels;
  labels.files = {{"labels/a.csv", {{"walk", 0.5, 0.7, "hop", "a", 1.0, 2}}}};
  EXPECT_TRUE(apply_labels(labels, records).empty());
  EXPECT_EQ(words_of(records[0]),
            "0.00-1.00 moving; 0.50-0.70 hop; 1.00-2.00 crouched; ");
}

TEST(LabelsDigest, DiffersWithEveryPartOfALabel) {
  ClipRecord clip = made_clip("walk.bvh", 0, 60);
  clip.labels = {{0.0, 1.0, "walk", "anna", 1.0}};
  const std::string before = labels_digest(clip);
  EXPECT_EQ(before.size(), 16u);
  clip.labels[0].certainty = 0.5;
  EXPECT_NE(labels_digest(clip), before);
  clip.labels[0] = {0.0, 1.0, "walkan", "na", 1.0};
  EXPECT_NE(labels_digest(clip), before);
  clip.labels[0] = {0.0, 1.0, "walk", "anna", 1.0};
  EXPECT_EQ(labels_digest(clip), before);
  clip.quality = Verdict::kPass;
  EXPECT_EQ(labels_digest(clip), before);
}

TEST(ApplyVerdicts, ReplacesTheVerdictAndTheQuality) {
  ClipRecord clip = made_clip("walk.bvh", 0, 60);
  const VerdictCorrection pass{
      clip.clip_id, "slide_cm_s", FrameRange{8, 12}, Verdict::kPass, "anna", ""};
  EXPECT_TRUE(apply_verdicts(clip, std::vector{pass}).empty());
  EXPECT_EQ(clip.figures[1].verdict, Verdict::kPass);
  EXPECT_EQ(clip.figures[1].value, 14.0);
  EXPECT_EQ(clip.quality, Verdict::kWarn);  // The spike still warns.
  ASSERT_EQ(clip.problems.size(), 1u);
  EXPECT_EQ(clip.problems[0].kind, "spike");
}

TEST(ApplyVerdicts, KeepsProblemsThatAnotherFigureConfirms) {
  ClipRecord clip = made_clip("walk.bvh", 0, 60);
  clip.figures[0].verdict = Verdict::kWarn;  // drift_mm has the same kind of problems.
  const VerdictCorrection pass{
      clip.clip_id, "slide_cm_s", std::nullopt, Verdict::kPass, "", ""};
  EXPECT_TRUE(apply_verdicts(clip, std::vector{pass}).empty());
  EXPECT_EQ(clip.problems.size(), 2u);
}

TEST(ApplyVerdicts, IgnoresACorrectionOfAnotherPlaceClipOrFigure) {
  ClipRecord clip = made_clip("walk.bvh", 0, 60);
  const std::vector<VerdictCorrection> corrections = {
      {clip.clip_id, "slide_cm_s", FrameRange{30, 40}, Verdict::kPass, "", ""},
      {"0123456789abcdef", "slide_cm_s", std::nullopt, Verdict::kPass, "", ""},
      {clip.clip_id, "height", std::nullopt, Verdict::kPass, "", ""}};
  EXPECT_EQ(apply_verdicts(clip, corrections).size(), 3u);
  EXPECT_EQ(clip.quality, Verdict::kFail);
  EXPECT_EQ(clip.problems.size(), 2u);
}

TEST(ApplyVerdicts, AddsAProblemForADefectThatWasMissed) {
  ClipRecord clip = made_clip("walk.bvh", 0, 60);
  const std::vector<VerdictCorrection> corrections = {
      {clip.clip_id, "drift_mm", FrameRange{2, 900}, Verdict::kFail, "", ""},
      {clip.clip_id, "quality", std::nullopt, Verdict::kWarn, "", ""}};
  EXPECT_TRUE(apply_verdicts(clip, corrections).empty());
  EXPECT_EQ(clip.figures[0].verdict, Verdict::kFail);
  ASSERT_EQ(clip.problems.size(), 3u);
  EXPECT_EQ(clip.problems[0].kind, "slide");
  EXPECT_EQ(clip.problems[0].frames.last, 60);
  EXPECT_EQ(clip.quality, Verdict::kWarn);
}

TEST(LibraryLabelFiles, AreReadInOrderAndTheFirstMistakeIsReported) {
  const ScratchFolder folder;
  EXPECT_TRUE(read_library_labels(folder.path()));
  const std::string header = "clip_or_source,start_s,end_s,label,by,sure\n";
  const auto write = [&](const std::string& name, const std::string& text) {
    ASSERT_TRUE(recordings::write_file(folder / "labels" / name, text));
  };
  write("b.csv", header + "walk,0,1,walk,,\n");
  write("a.csv", header + "walk,0,1,walk,anna,\n");
  write("a.csv.1", "not read");
  write(".c.csv", "not read");
  write("verdicts.csv", "clip,figure,frames,verdict,by,note\nabc,spike,,pass,bo,\n");
  const auto labels = read_library_labels(folder.path());
  ASSERT_TRUE(labels) << labels.error().message();
  ASSERT_EQ(labels->files.size(), 2u);
  EXPECT_EQ(labels->files[0].name, "labels/a.csv");
  EXPECT_EQ(labels->files[1].rows[0].by, "b");
  ASSERT_EQ(labels->verdicts.size(), 1u);
  std::vector<ClipRecord> records = {made_clip("walk.bvh", 0, 60)};
  const auto unused = apply_library_verdicts(*labels, records);
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_EQ(unused[0].cause, "no clip has the id \"abc\"");
  write("c.csv", header + "walk,0,1,walk\n");
  const auto broken = read_library_labels(folder.path());
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().where.find("labels/c.csv:2"), std::string::npos);
}

TEST(ApplyLabels, TakesLinearTimeForManyClips) {
  // No timing: 100 000 clips with quadratic work would take an hour.
  std::vector<ClipRecord> records;
  LibraryLabels labels;
  labels.files.push_back({"labels/a.csv", {}});
  for (int i = 0; i < 100'000; ++i) {
    ClipRecord& clip = records.emplace_back();
    clip.clip_id = "c" + std::to_string(i);
    clip.provenance.path = "walks/" + std::to_string(i / 4) + ".bvh";
    clip.first_frame = 60 * (i % 4);
    clip.last_frame = clip.first_frame + 59;
    clip.rate_hz = 30.0;
    labels.files[0].rows.push_back(
        {std::to_string(i / 4), 1.0, 3.0, "walk", "anna", 1.0, i + 2});
  }
  EXPECT_TRUE(apply_labels(labels, records).empty());
  EXPECT_EQ(words_of(records[4]), "1.00-1.96 walk; ");
  EXPECT_EQ(words_of(records[5]), "0.00-1.00 walk; ");
}

}  // namespace
}  // namespace marey::app
