// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Videos that cannot be right, noticed before any work.
#include <string>

#include <gtest/gtest.h>

#include "tests/app/blame.h"
#include "tests/app/broken_video.h"
#include "tests/app/spoiled_session.h"

namespace marey::testing {
namespace {

using ::testing::AssertionFailure;
using ::testing::AssertionResult;

/// Succeeds if the run declines at once, before any search or solution.
AssertionResult declines_at_once(const SpoiledSession& session, const Blame& blame) {
  const ProgramRun run = session.run();
  if (run.err.find("tags in") != std::string::npos ||
      run.err.find("cameras:") != std::string::npos) {
    return AssertionFailure() << "after work had begun\n" << run.err;
  }
  return declines(session, run, blame);
}

TEST(CheckVideos, DeclinesFramesBeyondTheEndOfALaterTrial) {
  SpoiledSession session;
  session.replace_in_trial(
      "walk", "kind = \"motion\"", "kind = \"motion\"\nframes = [0, 90]");
  EXPECT_TRUE(declines_at_once(
      session, {"session.toml:", "has only 90 (numbers 0 to 89)", "correct `frames`"}));
}

TEST(CheckVideos, DeclinesAVideoOnItsSide) {
  SpoiledSession session;
  copy_turned(SpoiledSession::sample_video("walk", "cam1"),
              session.new_video("walk", "cam1"),
              90,
              3);
  EXPECT_TRUE(declines_at_once(
      session, {"walk-cam1.mp4: ", "one of them is on its side", "same way round"}));
}

TEST(CheckVideos, DeclinesAnotherRotationMark) {
  SpoiledSession session;
  copy_marked_upside_down(SpoiledSession::sample_video("walk", "cam1"),
                          session.new_video("walk", "cam1"));
  EXPECT_TRUE(declines_at_once(
      session,
      {"walk-cam1.mp4: ", "turns its pictures by 180 degrees", "in one orientation"}));
}

TEST(CheckVideos, DeclinesImagesWithAGapInTheirNumbers) {
  SpoiledSession session;
  write_images_with_a_gap(SpoiledSession::sample_video("rom", "cam2"),
                          session.new_video("rom", "cam2"));
  EXPECT_TRUE(declines_at_once(session,
                               {"rom-cam2.mp4: ",
                                "2 images are missing between frame_006.png and "
                                "frame_009.png",
                                "timestamps"}));
}

TEST(CheckVideos, DeclinesFilesThatAreNoVideos) {
  SpoiledSession session;
  copy_part(session.file(), session.new_video("static", "cam0"), 1.0);
  EXPECT_TRUE(declines_at_once(
      session, {"static-cam0.mp4: ", "cannot be opened as a video", "Next: "}));
}

TEST(CheckVideos, DeclinesAMotionOfWhichOneVideoIsLeft) {
  SpoiledSession session;
  for (const char* camera : {"cam0", "cam1", "cam2"}) {
    copy_part(session.file(), session.new_video("walk", camera), 1.0);
  }
  EXPECT_TRUE(declines_at_once(
      session, {"walk-cam0.mp4: ", "cannot be opened as a video", "Next: "}));
}

TEST(TurnedVideo, ThatIsUpsideDownIsNamed) {
  SpoiledSession session;
  copy_turned(SpoiledSession::sample_video("walk", "cam1"),
              session.new_video("walk", "cam1"),
              180,
              90);
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"walk-cam1.mp4: ", "upside down", "180 degrees"},
                       {"calibration.html", "calibration.json", "calibration.toml"}));
}

TEST(AssessSides, ReportsATagOnTheWrongSegment) {
  SpoiledSession session;
  session.replace("segment = \"leftFoot\"", "segment = \"leftLowerLeg\"");
  const ProgramRun run = session.run("solve");
  EXPECT_NE(run.err.find("segment \"leftFoot\" has fewer tags than the other side, and "
                         "\"leftLowerLeg\" more"),
            std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace marey::testing
