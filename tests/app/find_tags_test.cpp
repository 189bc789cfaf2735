// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/find_tags.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "recordings/atomic_file.h"
#include "tests/support/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::Trial;
using recordings::TrialKind;
using testing::ScratchFolder;

// A motion goes on without: tests/app/take_process_test.cpp.
TEST(FindTags, DeclinesARecordedTrialOfAnotherKindThatLacksAVideo) {
  const ScratchFolder folder;
  recordings::Session session;
  session.file = folder / "session.toml";
  session.cameras = {"left", "right"};
  session.families = {{"tag36h11", {}}};
  for (const TrialKind kind : {TrialKind::kCalibration,
                               TrialKind::kFloor,
                               TrialKind::kStatic,
                               TrialKind::kRangeOfMotion}) {
    Trial trial;
    trial.name = "recorded";
    trial.kind = kind;
    trial.is_recorded = true;
    trial.videos = {{CameraId{0}, folder / "left.mkv", {}, 0},
                    {CameraId{1}, folder / "right.mkv", {}, 0}};
    // Without the check, this would be the error.
    ASSERT_TRUE(recordings::write_file(folder / "right.mkv", "no video"));
    Console console(ProgressStyle::kQuiet);
    RecordingTroubles troubles;
    const auto found = find_tags(session, trial, folder / "out", console, troubles);
    ASSERT_FALSE(found) << name(kind);
    EXPECT_EQ(found.error().code, Errc::kBadInput);
    EXPECT_EQ(found.error().where, (folder / "left.mkv").string());
    EXPECT_EQ(found.error().cause, "trial recorded has no recording of camera \"left\"");
  }
}

}  // namespace
}  // namespace marey::app
