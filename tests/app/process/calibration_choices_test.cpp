// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Effects of the [calibration] table of a session on `marey calibrate`.
#include <cmath>
#include <filesystem>
#include <string>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "core/camera.h"
#include "recordings/session/calibration_file.h"
#include "tests/app/blame.h"
#include "tests/app/broken_video.h"
#include "tests/app/spoiled_session.h"
#include "tests/support/program/paths.h"
#include "tests/support/truth/truth.h"

namespace marey::testing {
namespace {

/// Adds [calibration] with these lines.
void ask(SpoiledSession& session, const std::string& lines) {
  session.replace("[board]\n", "[calibration]\n" + lines + "\n[board]\n");
}

recordings::Calibration calibration_of(const SpoiledSession& session) {
  auto found = recordings::read_calibration(session.out() / "calibration.toml");
  EXPECT_TRUE(found) << found.error().message();
  return found ? std::move(*found) : recordings::Calibration{};
}

/// The worst of the cameras' places, [mm].
double worst_place_mm(const recordings::Calibration& found) {
  const auto truth =
      truth_cameras(marey::testing::sample_session() / "walk/truth/cameras.json");
  EXPECT_TRUE(truth);
  double worst = 0.0;
  for (std::size_t c = 0; truth && c < found.cameras.size(); ++c) {
    worst = std::max(
        worst,
        glm::distance(centre_in_world(found.cameras[c]), (*truth)[c].centre_in_world));
  }
  return 1e3 * worst;
}

/// Returns the largest error of the distances between cameras, which do not depend on the
/// world frame. [mm]
double worst_distance_mm(const recordings::Calibration& found) {
  const auto truth =
      truth_cameras(marey::testing::sample_session() / "walk/truth/cameras.json");
  EXPECT_TRUE(truth);
  double worst = 0.0;
  for (std::size_t a = 0; truth && a < found.cameras.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double is = glm::distance(centre_in_world(found.cameras[a]),
                                      centre_in_world(found.cameras[b]));
      const double should =
          glm::distance((*truth)[a].centre_in_world, (*truth)[b].centre_in_world);
      worst = std::max(worst, std::abs(is - should));
    }
  }
  return 1e3 * worst;
}

bool says(const ProgramRun& run, const std::string& words) {
  return run.err.find(words) != std::string::npos;
}

TEST(CalibrationChoices, LeaveCamerasOfOneClockAlone) {
  const SpoiledSession session;
  const ProgramRun run = session.run("calibrate");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(says(run, "clocks")) << run.err;
  for (const auto& clock : calibration_of(session).clocks) {
    EXPECT_EQ(clock.offset_s, 0.0);
  }
  EXPECT_TRUE(says(run, "cross-validation: reprojection error")) << run.err;
}

// As files of webcams that were started one after the other.
TEST(CalibrationChoices, FindOutThatCamerasStartedApart) {
  SpoiledSession session;
  copy_late(SpoiledSession::sample_video("calib", "cam1"),
            session.new_video("calib", "cam1"),
            3);
  copy_late(SpoiledSession::sample_video("calib", "cam2"),
            session.new_video("calib", "cam2"),
            5);
  const ProgramRun run = session.run("calibrate");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(says(run, "the cameras' clocks in the calibration")) << run.err;
  const auto found = calibration_of(session);
  EXPECT_NEAR(found.clocks[1].offset_s, 0.6, 0.005);
  EXPECT_NEAR(found.clocks[2].offset_s, 1.0, 0.005);
  EXPECT_NEAR(found.clocks[3].offset_s, 0.0, 0.005);
  EXPECT_LE(worst_place_mm(found), 20.0);
}

TEST(CalibrationChoices, LetTheCommandLineChooseTheLens) {
  const SpoiledSession session;
  const ProgramRun run = session.run("calibrate", {"--lens", "rational"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(calibration_of(session).cameras[0].intrinsics.lens, LensModel::kRational);
  EXPECT_EQ(session.run("calibrate", {"--lens", "round"}).exit_code, 2);
}

TEST(CalibrationChoices, FindTheSimplestLensThatServes) {
  SpoiledSession session;
  ask(session, "lens = \"auto\"");
  const ProgramRun run = session.run("calibrate");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(says(run, "chosen lens model: brown-conrady")) << run.err;
}

TEST(CalibrationChoices, TakeLensesAsTheyAre) {
  SpoiledSession session;
  const std::string earlier = marey::testing::sample_results() / "once/calibration.toml";
  ask(session, "lenses = \"" + earlier + "\"\nwarp = true");
  const ProgramRun run = session.run("calibrate");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto known = recordings::read_calibration(earlier);
  ASSERT_TRUE(known);
  const auto found = calibration_of(session);
  for (std::size_t c = 0; c < found.cameras.size(); ++c) {
    EXPECT_EQ(found.cameras[c].intrinsics.parameters(),
              known->cameras[c].intrinsics.parameters());
  }
  EXPECT_TRUE(says(run, "the lenses of cam0, cam1, cam2, cam3 are taken from"));
  EXPECT_TRUE(says(run, "the board is flat")) << run.err;
  EXPECT_LE(worst_place_mm(found), 15.0);
}

/// The sample's calibration, spoiled.
std::string spoiled_lenses(const SpoiledSession& session,
                           const std::function<void(recordings::Calibration&)>& spoil) {
  auto known = recordings::read_calibration(marey::testing::sample_results() /
                                            "once/calibration.toml");
  EXPECT_TRUE(known);
  spoil(*known);
  const auto file = session.file().parent_path() / "lenses.toml";
  EXPECT_TRUE(recordings::write_calibration(file, *known));
  return "lenses = \"lenses.toml\"";
}

TEST(CalibrationChoices, DeclineLensesOfOtherPictures) {
  SpoiledSession session;
  ask(session, spoiled_lenses(session, [](recordings::Calibration& known) {
        known.cameras[2].intrinsics.width_px = 1920;
        known.cameras[2].intrinsics.height_px = 1080;
      }));
  EXPECT_TRUE(declines(
      session,
      session.run("calibrate"),
      {"lenses.toml: ", "\"cam2\" is for pictures of 1920 x 1080", "of this size"}));
}

TEST(CalibrationChoices, DeclineLensesOfOtherCameras) {
  SpoiledSession session;
  ask(session, spoiled_lenses(session, [](recordings::Calibration& known) {
        for (Camera& camera : known.cameras) camera.name += "-old";
      }));
  EXPECT_TRUE(declines(
      session,
      session.run("calibrate"),
      {"session.toml:", "no lens of a camera of the session", "same camera names"}));
}

// --- The floor
// --------------------------------------------------------------------------

/// Takes a trial out of the session.
void without_trial(SpoiledSession& session, const std::string& trial) {
  session.replace("name = \"" + trial + "\"\nkind = \"floor\"\nframes = [0, 3]",
                  "name = \"" + trial + "\"\nkind = \"motion\"\nframes = [0, 3]");
}

// The lowest tag's corner is 77 mm above the floor, and the cameras lean by two degrees.
TEST(CalibrationChoices, StandTheWorldOnTheSubject) {
  SpoiledSession session;
  without_trial(session, "floor");
  ask(session, "lowest_corner_m = 0.077");
  const ProgramRun run = session.run("calibrate");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(says(run, "the lowest corner of a tag in trial static")) << run.err;
  const auto found = calibration_of(session);
  EXPECT_LE(worst_distance_mm(found), 15.0);
  const auto truth =
      truth_cameras(marey::testing::sample_session() / "walk/truth/cameras.json");
  ASSERT_TRUE(truth);
  for (std::size_t c = 0; c < found.cameras.size(); ++c) {
    // Two degrees at three metres.
    EXPECT_NEAR(centre_in_world(found.cameras[c]).y, (*truth)[c].centre_in_world.y, 0.15);
  }
}

TEST(CalibrationChoices, ProcessWithoutAFloorTrial) {
  SpoiledSession session;
  without_trial(session, "floor");
  session.replace("kind = \"motion\"\nframes = [0, 3]\nvideos = { cam0 = \"calib",
                  "kind = \"motion\"\nframes = [0, 3]\nvideos = { cam0 = \"walk");
  for (const char* camera : {"cam1", "cam2", "cam3"}) {
    const std::string name(camera);
    session.replace_in_trial("floor", name + " = \"calib", name + " = \"walk");
  }
  ask(session, "lowest_corner_m = 0.077");
  const ProgramRun run = session.run();
  EXPECT_TRUE(session.has_result("walk/joints.csv")) << run.err;
}

// The floor trial declares frame 40, in which the board is held up.
TEST(CalibrationChoices, DeclineAFloorThatIsAWall) {
  SpoiledSession session;
  session.replace_in_trial("floor", "frames = [0, 3]", "frames = [40, 40]");
  session.replace_in_trial(
      "floor",
      ", cam1 = \"calib/cam1.mp4\", cam2 = \"calib/cam2.mp4\", cam3 = "
      "\"calib/cam3.mp4\"",
      "");
  EXPECT_TRUE(declines(
      session,
      session.run("calibrate"),
      {"session.toml: ", "the subject of trial static", "the board lay on the floor"}));
}

}  // namespace
}  // namespace marey::testing
