// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/check_command.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/library/library_index.h"
#include "tests/app/library/check/checked_clips.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using marey::testing::checked_clips;
using marey::testing::read_text;
using marey::testing::ScratchFolder;
using Json = nlohmann::json;

class LibraryCheckCommand : public ::testing::Test {
 protected:
  /// Makes the library of these clips.
  void make(const std::vector<ClipRecord>& clips) {
    ASSERT_TRUE(recordings::write_file(library_ / "library.toml",
                                       "format = 1\nname = \"walks\"\n"));
    ASSERT_TRUE(recordings::write_library_index(library_ / "library.sqlite", clips));
  }

  Exit run(const LibraryCheckArguments& args) {
    Console console(ProgressStyle::kAuto);
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const Exit exit = run_library_check(args, console);
    out_ = ::testing::internal::GetCapturedStdout();
    err_ = ::testing::internal::GetCapturedStderr();
    return exit;
  }

  [[nodiscard]] LibraryCheckArguments arguments() const {
    LibraryCheckArguments args;
    args.library = library_.path();
    return args;
  }

  ScratchFolder library_;
  std::string out_;
  std::string err_;
};

/// Clips with a verdict of this or a better one.
std::vector<ClipRecord> clips_up_to(Verdict worst) {
  std::vector<ClipRecord> clips = checked_clips(300);
  std::erase_if(clips, [&](const ClipRecord& clip) { return clip.quality > worst; });
  return clips;
}

TEST_F(LibraryCheckCommand, ReturnsTheExitCodeOfTheWorstClip) {
  LibraryCheckArguments args = arguments();
  make(clips_up_to(Verdict::kPass));
  args.fail_on = "warn";
  EXPECT_EQ(run(args), Exit::kOk) << err_;
  make(clips_up_to(Verdict::kWarn));
  EXPECT_EQ(run(args), Exit::kQualityGate);
  EXPECT_NE(err_.find("clips that fail: 0, that warn: "), std::string::npos) << err_;
  args.fail_on = "fail";
  EXPECT_EQ(run(args), Exit::kOk);
  make(clips_up_to(Verdict::kFail));
  EXPECT_EQ(run(args), Exit::kQualityGate);
  EXPECT_NE(err_.find("Next: open the page"), std::string::npos) << err_;
  EXPECT_NE(out_.find("worst clips:"), std::string::npos);
  EXPECT_FALSE(read_text(library_ / "check.html").empty());
}

TEST_F(LibraryCheckCommand, PrintsJsonAloneOnStandardOutput) {
  make(clips_up_to(Verdict::kFail));
  LibraryCheckArguments args = arguments();
  args.json = true;
  args.page = library_ / "pages/mine.html";
  EXPECT_EQ(run(args), Exit::kQualityGate);
  const Json json = Json::parse(out_);
  EXPECT_EQ(json["library"], "walks");
  EXPECT_EQ(json["clips"].size(), 300u);
  EXPECT_TRUE(std::filesystem::exists(args.page));
  EXPECT_FALSE(std::filesystem::exists(library_ / "check.html"));
}

TEST_F(LibraryCheckCommand, ChecksTheClipsOfAQuery) {
  make(clips_up_to(Verdict::kFail));
  ASSERT_TRUE(
      recordings::write_file(library_ / "failed/x.bvh.txt", "x.bvh\nCause: y.\n"));
  LibraryCheckArguments args = arguments();
  args.json = true;
  EXPECT_EQ(run(args), Exit::kQualityGate);
  EXPECT_EQ(Json::parse(out_)["failed"].size(), 1u);
  args.query = "quality=pass";
  EXPECT_EQ(run(args), Exit::kOk) << err_;
  const Json json = Json::parse(out_);
  EXPECT_EQ(json["verdicts"]["fail"]["clips"], 0);
  EXPECT_GT(json["total"]["clips"], 200);
  EXPECT_EQ(json["failed"].size(), 0u);
  args.query = "name=nothing";
  EXPECT_EQ(run(args), Exit::kOk);
  EXPECT_NE(err_.find("no clip fits the query"), std::string::npos) << err_;
  args.query = "quality==(";
  EXPECT_EQ(run(args), Exit::kUsage) << err_;
}

TEST_F(LibraryCheckCommand, ReportsALibraryThatCannotBeChecked) {
  EXPECT_EQ(run(arguments()), Exit::kBadInput);
  EXPECT_NE(err_.find("library.toml"), std::string::npos) << err_;
  make({});
  EXPECT_EQ(run(arguments()), Exit::kOk);
  EXPECT_NE(err_.find("the library has no clips. Next: "), std::string::npos) << err_;
  std::filesystem::remove(library_ / "library.sqlite");
  EXPECT_EQ(run(arguments()), Exit::kBadInput);
  make({});
  LibraryCheckArguments args = arguments();
  args.page = library_.path();
  EXPECT_EQ(run(args), Exit::kBadInput);
}

}  // namespace
}  // namespace marey::app
