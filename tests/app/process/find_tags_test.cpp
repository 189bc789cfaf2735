// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/find_tags.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/check/check_target_seen.h"
#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::Trial;
using recordings::TrialKind;
using testing::ScratchFolder;

// A motion goes on without: tests/app/process/take_process_test.cpp.
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
    std::vector<Finding> findings;
    const auto found = find_tags(session, trial, folder / "out", console, findings);
    ASSERT_FALSE(found) << name(kind);
    EXPECT_EQ(found.error().code, Errc::kBadInput);
    EXPECT_EQ(found.error().where, (folder / "left.mkv").string());
    EXPECT_EQ(found.error().cause, "trial recorded has no recording of camera \"left\"");
  }
}

/// A floor trial of three cameras whose frames show so many tags of the board.
struct FloorScene {
  explicit FloorScene(std::array<int, 3> tags) {
    session.cameras = {"left", "middle", "right"};
    session.families = {{"tag36h11", {TagId{0}}}};
    session.target = AprilGrid{6, 6, 0.1, 0.03, 0, 0.0};
    trial.name = "floor";
    trial.kind = TrialKind::kFloor;
    wanted.shows_grid = true;
    for (int c = 0; c < 3; ++c) {
      trial.videos.push_back({CameraId{c}, "nowhere.mp4", {}, 0});
      CameraDetections& camera = found.emplace_back();
      camera.camera = CameraId{c};
      camera.source = "floor/" + session.cameras[static_cast<std::size_t>(c)] + ".mp4";
      FrameDetections& frame = camera.frames.emplace_back();
      for (int tag = 0; tag < tags[static_cast<std::size_t>(c)]; ++tag) {
        frame.tags.emplace_back().id = TagId{tag};
      }
    }
  }
  Status check() { return check_floor_seen(session, trial, found, wanted, findings); }

  recordings::Session session;
  Trial trial;
  std::vector<CameraDetections> found;
  ContentToDetect wanted;
  std::vector<Finding> findings;
};

TEST(CheckFloorSeen, ReportsCamerasThatSeeTooLittle) {
  for (const int few : {0, 1, 2}) {
    FloorScene scene({20, few, 3});
    ASSERT_TRUE(scene.check());
    ASSERT_EQ(scene.findings.size(), 1U);
    const std::string warning = scene.findings[0].message();
    EXPECT_NE(warning.find("camera \"middle\" sees"), std::string::npos) << warning;
    EXPECT_NE(warning.find("the floor is taken from left, right"), std::string::npos);
    EXPECT_EQ(warning.find("widen"), std::string::npos) << warning;
  }
}

TEST(CheckFloorSeen, PassesIfAllCamerasSeeEnough) {
  FloorScene scene({20, 3, 9});
  ASSERT_TRUE(scene.check());
  EXPECT_TRUE(scene.findings.empty());
}

TEST(CheckFloorSeen, DeclinesAnUnseenFloor) {
  FloorScene scene({0, 0, 0});
  const Status checked = scene.check();
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Errc::kBadInput);
}

}  // namespace
}  // namespace marey::app
