// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/annotate_command.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/library/labels/library_labels.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/library_index.h"
#include "tests/app/library/labels/library_records.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using marey::testing::made_clip;
using marey::testing::read_text;
using marey::testing::ScratchFolder;
using Json = nlohmann::json;

constexpr const char* kTableHeader = "clip_or_source,start_s,end_s,label,by,sure\n";

/// Exit code of a command, and its output.
struct AnnotateRun {
  Exit exit = Exit::kInternal;
  std::string out;
  std::string err;
};

AnnotateRun annotate(const LibraryAnnotateArguments& args) {
  AnnotateRun run;
  Console console(ProgressStyle::kAuto);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  run.exit = run_library_annotate(args, console);
  run.out = ::testing::internal::GetCapturedStdout();
  run.err = ::testing::internal::GetCapturedStderr();
  return run;
}

class LibraryAnnotate : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::vector<ClipRecord> records = {
        made_clip("a/walk.bvh", 0, 60),
        made_clip("a/walk.bvh", 61, 120),
        made_clip("amass/CMU/02/02_01_poses.npz", 0, 9),
        made_clip("b/walk.bvh", 0, 60)};
    ASSERT_TRUE(recordings::write_library_index(library_ / "library.sqlite", records));
  }

  [[nodiscard]] LibraryAnnotateArguments import(const std::string& name,
                                                const std::string& text) const {
    EXPECT_TRUE(recordings::write_file(library_ / name, text));
    LibraryAnnotateArguments args;
    args.library = library_.path();
    args.import = library_ / name;
    return args;
  }

  ScratchFolder library_;
};

TEST_F(LibraryAnnotate, StoresExactNamesAndReportsTheOthers) {
  auto args =
      import("anna.csv",
             std::string(kTableHeader) +
                 "b/walk,0,1,walk,,\nwalk,0,1,walk,,\nrun,0,1,run,,\nrun,1,2,run,,"
                 "\na/walk.bvh,,,walk,bo,0.5\n");
  args.json = true;
  const AnnotateRun run = annotate(args);
  EXPECT_EQ(run.exit, Exit::kOk) << run.err;
  EXPECT_EQ(read_text(library_ / "labels/anna.csv"),
            std::string(kTableHeader) +
                "b/walk.bvh,0,1,walk,anna,1\na/walk.bvh,,,walk,bo,0.5\n");
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json["labels"], 2);
  EXPECT_EQ(json["clips"], 3);
  EXPECT_EQ(json["unknown"]["labels"], 2);
  EXPECT_EQ(json["unknown"]["names"], Json({"run"}));
  EXPECT_EQ(json["ambiguous"]["names"], Json({"walk"}));
  EXPECT_EQ(json["state"], "new");
  EXPECT_NE(run.err.find("2 labels not used, as no clip or source has their name: "
                         "\"run\". Next: "),
            std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("marey library build"), std::string::npos) << run.err;
  EXPECT_TRUE(read_library_labels(library_.path()));
}

TEST_F(LibraryAnnotate, OverwritesNoTable) {
  auto args = import("anna.csv", std::string(kTableHeader) + "b/walk,0,1,walk,,\n");
  EXPECT_EQ(annotate(args).exit, Exit::kOk);
  const AnnotateRun again = annotate(args);
  EXPECT_EQ(again.exit, Exit::kOk);
  EXPECT_NE(again.err.find("nothing to do"), std::string::npos);
  const std::string first = read_text(library_ / "labels/anna.csv");
  args = import("anna.csv", std::string(kTableHeader) + "b/walk,0,1,run,,\n");
  const AnnotateRun other = annotate(args);
  EXPECT_EQ(other.exit, Exit::kBadInput);
  EXPECT_NE(other.err.find("--replace"), std::string::npos) << other.err;
  EXPECT_EQ(read_text(library_ / "labels/anna.csv"), first);
  args.replace = true;
  EXPECT_EQ(annotate(args).exit, Exit::kOk);
  EXPECT_NE(read_text(library_ / "labels/anna.csv"), first);
  EXPECT_EQ(read_text(library_ / "labels/anna.csv.1"), first);
  const auto labels = read_library_labels(library_.path());
  ASSERT_TRUE(labels);
  EXPECT_EQ(labels->files.size(), 1u);
}

TEST_F(LibraryAnnotate, ReadsBabel) {
  auto args =
      import("train.json",
             R"({"1": {"feat_p": "CMU/CMU/02/02_01_poses.npz", "seq_ann": {"labels": [
          {"raw_label": "walk", "proc_label": "walk", "act_cat": ["walk"]}]}},
          "2": {"feat_p": "KIT/KIT/3/kick_poses.npz", "seq_ann": {"labels": [
          {"raw_label": "kick", "proc_label": "kick", "act_cat": ["kick"]}]}}})");
  args.by = "babel";
  const AnnotateRun run = annotate(args);
  EXPECT_EQ(run.exit, Exit::kOk) << run.err;
  EXPECT_EQ(read_text(library_ / "labels/babel.csv"),
            std::string(kTableHeader) +
                "amass/CMU/02/02_01_poses.npz,,,walk,babel,1\n"
                "amass/CMU/02/02_01_poses.npz,,,act_cat:walk,babel,1\n");
}

TEST_F(LibraryAnnotate, NamesFiveOfManyUnknownNames) {
  std::string text = kTableHeader;
  for (int i = 0; i < 20; ++i) text += "x" + std::to_string(i) + ",0,1,walk,,\n";
  const AnnotateRun run = annotate(import("anna.csv", text));
  EXPECT_EQ(run.exit, Exit::kBadInput);
  EXPECT_NE(run.err.find("\"x4\" and 15 more"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("none of its labels belongs to a clip"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(library_ / "labels"));
}

TEST_F(LibraryAnnotate, RefusesNamesAndFilesThatCannotBeStored) {
  auto args = import("anna.csv", std::string(kTableHeader) + "b/walk,0,1,walk,,\n");
  for (const char* name : {"verdicts", "page", "marey", "../x", ".x"}) {
    args.by = name;
    EXPECT_EQ(annotate(args).exit, Exit::kUsage) << name;
  }
  EXPECT_EQ(annotate(import("anna.txt", "walk")).exit, Exit::kBadInput);
  EXPECT_EQ(annotate(import("anna.csv", kTableHeader)).exit, Exit::kBadInput);
  args.by.clear();
  args.import = library_ / "missing.csv";
  EXPECT_EQ(annotate(args).exit, Exit::kBadInput);
  const ScratchFolder other;
  args = import("anna.csv", std::string(kTableHeader) + "b/walk,0,1,walk,,\n");
  args.library = other.path();
  EXPECT_EQ(annotate(args).exit, Exit::kBadInput);
}

}  // namespace
}  // namespace marey::app
