// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/export_options.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/library/export/clip_tables.h"
#include "app/library/export/export_commands.h"
#include "tests/app/library/export/export_scene.h"

namespace marey::app {
namespace {

TEST(ExportOptions, ReadSplits) {
  EXPECT_EQ(*parse_split("80/10/10"),
            (SplitShares{{"train", 0.8}, {"val", 0.1}, {"test", 0.1}}));
  EXPECT_EQ(*parse_split("90/10"), (SplitShares{{"train", 0.9}, {"test", 0.1}}));
  EXPECT_EQ(*parse_split("100"), (SplitShares{{"train", 1.0}}));
  for (const char* bad : {"",
                          "80",
                          "80/30",
                          "80/10/10/0",
                          "a/b",
                          "80/-10/30",
                          "80/20/",
                          "nan",
                          "50,50",
                          "1e999"}) {
    const auto split = parse_split(bad);
    ASSERT_FALSE(split) << bad;
    EXPECT_EQ(split.error().code, Errc::kUsage);
  }
}

TEST(ExportOptions, ComeFromTheLibraryUnlessGiven) {
  LibrarySettings settings;
  settings.skeleton = "lafan22";
  settings.rate_hz = 30.0;
  settings.splits = {{"train", 0.5}, {"test", 0.5}};
  LibraryExportArguments args;
  args.format = "npz";
  args.allowed_licences = {"CC-BY-NC-4.0, free, for research"};
  const auto plain = resolve_export(args, settings);
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->skeleton, "lafan22");
  EXPECT_EQ(plain->rate_hz, 30.0);
  EXPECT_EQ(plain->splits, settings.splits);
  EXPECT_EQ(
      plain->allowance.licences,
      (std::vector<std::string>{
          "CC-BY-NC-4.0, free, for research", "CC-BY-NC-4.0", "free", "for research"}));
  args.rate_hz = 20.0;
  args.skeleton = "own";
  args.split = "100";
  args.split_by = "clip";
  const auto given = resolve_export(args, settings);
  ASSERT_TRUE(given);
  EXPECT_EQ(given->skeleton, "own");
  EXPECT_EQ(given->rate_hz, 20.0);
  EXPECT_EQ(given->splits.size(), 1u);
  EXPECT_EQ(given->split_by, library::SplitBy::kClip);
  args.split = "1/2";
  EXPECT_FALSE(resolve_export(args, settings));
}

TEST(ExportOptions, ChooseOneSkeletonWhereTheLayoutNeedsIt) {
  LibrarySettings settings;
  EXPECT_EQ(skeleton_of_export(ExportFormat::kNpz, "", settings), "own");
  EXPECT_EQ(skeleton_of_export(ExportFormat::kAmass, "", settings), "smpl22");
  EXPECT_EQ(skeleton_of_export(ExportFormat::kPack, "", settings), "marey");
  EXPECT_EQ(skeleton_of_export(ExportFormat::kPack, "own", settings), "own");
  settings.skeleton = "lafan22";
  EXPECT_EQ(skeleton_of_export(ExportFormat::kPack, "", settings), "lafan22");
  EXPECT_EQ(skeleton_of_export(ExportFormat::kJoints22, "", settings), "smpl22");
}

TEST(ExportOptions, RefuseASkeletonThatDoesNotExist) {
  const testing::ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kNpz, "e");
  options.skeleton = "smpl24";
  const auto report = scene.run(options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message(),
            "--skeleton smpl24: is no skeleton of marey, and there is no such file. "
            "Next: give own, marey, smpl22, lafan22, or the file of a body.");
}

TEST(ClipTables, QuoteFieldsThatNeedIt) {
  std::string line;
  append_csv(line, "plain");
  append_csv(line, "a,b");
  append_csv(line, "say \"yes\"\nor no");
  EXPECT_EQ(line, "plain\"a,b\"\"say \"\"yes\"\"\nor no\"");
}

TEST(PrintExport, WarnsOfClipsWithoutSubject) {
  const testing::ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kTable, "e");
  const auto report = scene.run(options);
  ASSERT_TRUE(report);
  EXPECT_EQ(count_without_subject(*report), 1u);
  Console console(ProgressStyle::kQuiet);
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(print_export(*report, options, false, console), Exit::kOk);
  const std::string messages = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(messages.find("1 of 4 clips have no subject; the splits can divide a person"),
            std::string::npos)
      << messages;
  options.split_by = library::SplitBy::kClip;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(print_export(*report, options, false, console), Exit::kOk);
  EXPECT_EQ(::testing::internal::GetCapturedStderr().find("no subject"),
            std::string::npos);
}

TEST(PrintExport, WritesJson) {
  const testing::ExportScene scene;
  ExportOptions options = scene.options(ExportFormat::kAmass, "e");
  options.adds_mirrored = true;
  const auto report = scene.run(options);
  ASSERT_TRUE(report);
  Console console(ProgressStyle::kQuiet);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(print_export(*report, options, true, console), Exit::kQualityGate)
      << "a clip was left out";
  const std::string text = ::testing::internal::GetCapturedStdout();
  const std::string messages = ::testing::internal::GetCapturedStderr();
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["clips"], 6);
  EXPECT_EQ(json["left_out"][0]["name"], "stiff");
  EXPECT_EQ(json["labels_without_other_side"][0]["label"], "a \"leftish\", step");
  EXPECT_EQ(json["licences"][0]["licence"], "CC-BY-4.0");
  EXPECT_NE(messages.find("1 of 4 selected clips cannot be exported; the first, stiff"),
            std::string::npos)
      << messages;
  EXPECT_NE(messages.find("its other side is not known"), std::string::npos) << messages;
}

}  // namespace
}  // namespace marey::app
