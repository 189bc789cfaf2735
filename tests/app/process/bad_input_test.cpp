// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Frequent mistakes of users. Each run must report one error that names the file, the
// cause and the next step. A run that fails must leave no file that looks like a result.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/blame.h"
#include "tests/app/broken_video.h"
#include "tests/app/spoiled_session.h"

namespace marey::testing {
namespace {

using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;

const std::vector<std::string> kCalibrated{
    "calibration.html", "calibration.json", "calibration.toml"};

// --- session.toml
// -----------------------------------------------------------------------

TEST(BadSession, WithAWrongKeyIsDeclinedAtItsLine) {
  SpoiledSession session;
  session.replace("stature_m", "statur_m");
  EXPECT_TRUE(declines(
      session, session.run(), {"session.toml:9: ", "\"statur_m\"", "\"stature_m\""}));
}

TEST(BadSession, WithoutAKeyThatIsNeededIsDeclined) {
  SpoiledSession session;
  session.replace("stature_m = 1.734\n", "");
  EXPECT_TRUE(
      declines(session,
               session.run(),
               {"session.toml:7: ", "the key \"stature_m\" is missing", "add it"}));
}

TEST(BadSession, WithATagOnTwoSegmentsIsDeclined) {
  SpoiledSession session;
  session.replace("id = 46", "id = 41");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml:", "tag 41 is listed twice", "correct its id"}));
}

TEST(BadSession, WithABodyTagThatIsOnTheBoardIsDeclined) {
  SpoiledSession session;
  session.replace("id = 46", "id = 7");
  EXPECT_TRUE(
      declines(session,
               session.run(),
               {"session.toml:", "tag 7 is on the body and on the board", "another id"}));
}

TEST(BadSession, WithAVideoThatIsNotThereIsDeclinedByItsLine) {
  SpoiledSession session;
  session.replace("walk/cam2.mp4", "walk/cam9.mp4");
  EXPECT_TRUE(declines(session, session.run(), {"session.toml:", "walk/cam9.mp4", ""}));
}

TEST(BadSession, WithoutATrialThatTheStageNeedsIsDeclinedBeforeAnyWork) {
  SpoiledSession session;
  session.replace_in_trial("static", "kind = \"static\"", "kind = \"motion\"");
  const ProgramRun run = session.run();
  EXPECT_TRUE(declines(
      session, run, {"session.toml: ", "no trial of kind \"static\"", "record one"}));
  EXPECT_EQ(run.err.find("tags in"), std::string::npos) << run.err;
}

TEST(BadSession, WithTwoStaticTrialsIsDeclinedByTheSecondsLine) {
  SpoiledSession session;
  session.replace_in_trial("rom", "kind = \"range-of-motion\"", "kind = \"static\"");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml:", "\"static\" already has the kind", "keep the"}));
}

TEST(BadSession, IsDeclinedWhenTheFloorUsesTheWholeCalibration) {
  SpoiledSession session;
  session.replace_in_trial("floor", "frames = [0, 3]\n", "");
  EXPECT_TRUE(declines(
      session,
      session.run(),
      {"session.toml:", "the whole of a video of trial \"calib\"", "frames = ["}));
}

TEST(BadSession, WithAnOffsetOfManyFramesIsDeclined) {
  SpoiledSession session;
  session.replace_in_trial("walk",
                           "kind = \"motion\"\n",
                           "kind = \"motion\"\ntime_offset_s = { cam1 = 0.5 }\n");
  EXPECT_TRUE(
      declines(session,
               session.run(),
               {"session.toml:", "\"cam1\" is more than two frames", "start within"}));
}

TEST(BadAvatar, IsReportedBeforeAnyWorkWhenMissing) {
  SpoiledSession session;
  const ProgramRun run = session.run("process", {"--avatar", "no-such-body.glb"});
  EXPECT_TRUE(declines(session, run, {"no-such-body.glb: ", "does not exist", "check"}));
  EXPECT_EQ(run.err.find("tags in"), std::string::npos) << run.err;
}

// --- Videos
// -----------------------------------------------------------------------------

/// Returns success if the run reported one error, repeated it in the JSON report, and
/// wrote the motion.
AssertionResult goes_on(const SpoiledSession& session,
                        const ProgramRun& run,
                        const std::string& where,
                        const std::string& cause) {
  if (run.exit_code != 3) {
    return AssertionFailure() << "exit code " << run.exit_code << "\n" << run.err;
  }
  const auto errors = error_lines(run.err);
  if (errors.size() != 1 || errors.front().find(where) == std::string::npos ||
      errors.front().find(cause) == std::string::npos) {
    return AssertionFailure() << "expected \"" << where << "\", \"" << cause << "\" in\n"
                              << run.err;
  }
  const auto report = nlohmann::json::parse(run.out);
  if (report.at("warnings").dump().find(cause) == std::string::npos) {
    return AssertionFailure() << "the report does not contain the cause";
  }
  if (!session.has_result("walk/joints.csv")) return AssertionFailure() << "no motion";
  return AssertionSuccess();
}

TEST(BadVideo, IsLeftOutWhenAMotionIsCutBeforeItsIndex) {
  SpoiledSession session;
  copy_part_without_index(SpoiledSession::sample_video("walk", "cam1"),
                          session.new_video("walk", "cam1"),
                          0.6);
  EXPECT_TRUE(
      goes_on(session, session.run(), "walk-cam1.mp4: ", "cannot be opened as a video"));
}

TEST(BadVideo, IsUsedUpToTheCutWhenAMotionIsCutAfterItsIndex) {
  SpoiledSession session;
  copy_part(SpoiledSession::sample_video("walk", "cam1"),
            session.new_video("walk", "cam1"),
            0.6);
  EXPECT_TRUE(goes_on(session, session.run(), "walk-cam1.mp4: ", " of 90 frames"));
}

TEST(BadVideo, WithoutASingleTagIsNamed) {
  SpoiledSession session;
  write_grey_video(SpoiledSession::sample_video("walk", "cam3"),
                   session.new_video("walk", "cam3"),
                   90);
  EXPECT_TRUE(
      declines(session,
               session.run(),
               {"walk-cam3.mp4: ", "no tag is seen in its 90 frames", "leave this camera"}));
}

TEST(BadVideo, ThatIsATextFileCannotBeOpened) {
  SpoiledSession session;
  copy_part(session.file(), session.new_video("static", "cam0"), 1.0);
  EXPECT_TRUE(declines(
      session, session.run(), {"static-cam0.mp4: ", "cannot be opened as a video", "."}));
}

// --- Sizes that were not measured
// -------------------------------------------------------

TEST(BadSize, IsDetectedForAllTagsAgainstTheBoard) {
  SpoiledSession session;
  session.replace("size_m = 0.09\n", "size_m = 0.18\n");
  session.replace("\nsize_m = 0.075\n", "\nsize_m = 0.15\n");
  EXPECT_TRUE(declines(
      session, session.run(), {"session.toml: [[tags.tag]]", "0.50 times", "size_m"}));
}

// Two cameras see it only while the subject moves.
TEST(BadSize, IsDetectedForOneTagByItsNumber) {
  SpoiledSession session;
  session.replace("id = 41\nsegment = \"hips\"\nsize_m = 0.09",
                  "id = 41\nsegment = \"hips\"\nsize_m = 0.18");
  EXPECT_TRUE(declines(
      session,
      session.run(),
      {"session.toml: [[tags.tag]]: ", "tag 41 measures 0.09", "measure the print"},
      kCalibrated));
}

TEST(BadSize, IsDetectedForTheBoardAgainstTheTags) {
  SpoiledSession session;
  session.replace("tag_size_m = 0.1\n", "tag_size_m = 0.2\n");
  session.replace("gap_m = 0.03", "gap_m = 0.06");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml: [[tags.tag]]", "2.00 times", "tag_size_m"}));
}

TEST(BadSize, IsDetectedForTheTagsOfTheBoardAlone) {
  SpoiledSession session;
  session.replace("tag_size_m = 0.1\n", "tag_size_m = 0.2\n");
  EXPECT_TRUE(declines(session, session.run(), {"session.toml", "board", "gap_m"}));
}

TEST(BadSize, IsDetectedForThePersonByTheLimbs) {
  SpoiledSession session;
  session.replace("stature_m = 1.734", "stature_m = 0.9");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml", "times those of a person of 0.90 m", "stature_m"},
                       kCalibrated));
}

// --- Cameras
// ----------------------------------------------------------------------------

/// Exchanges the videos of cam0 and cam1 in a trial.
void swap_cameras(SpoiledSession& session, const std::string& trial) {
  session.replace_in_trial(trial, "cam0 = ", "camX = ");
  session.replace_in_trial(trial, "cam1 = ", "cam0 = ");
  session.replace_in_trial(trial, "camX = ", "cam1 = ");
}

TEST(ExchangedCameras, InTheWalkAreNamed) {
  SpoiledSession session;
  swap_cameras(session, "walk");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"walk/cam1.mp4 and ", "look exchanged", "exchange them"},
                       kCalibrated));
}

TEST(ExchangedCameras, InTheCalibrationAreDetectedInLaterTrials) {
  SpoiledSession session;
  swap_cameras(session, "calib");
  swap_cameras(session, "floor");
  EXPECT_TRUE(
      declines(session, session.run(), {"/cam1.mp4", "look exchanged", "calibration"}));
}

TEST(ExchangedCameras, InTheWavedTrialAloneAreNamedByTheFloor) {
  SpoiledSession session;
  swap_cameras(session, "calib");
  EXPECT_TRUE(declines(
      session,
      session.run(),
      {"/cam1.mp4", "look exchanged: the board on the floor", "calibration trial's"}));
}

TEST(ExchangedCameras, InTheFloorTrialAloneAreNamed) {
  SpoiledSession session;
  swap_cameras(session, "floor");
  EXPECT_TRUE(
      declines(session,
               session.run(),
               {"/cam1.mp4", "look exchanged: the board on the floor", "floor trial's"}));
}

// The board shows itself to cam0 in the even frames, to the others in the odd ones, and
// on the floor not to cam0 at all.
TEST(BadCalibration, WithABoardThatNoTwoCamerasSeeTogetherNamesTheCamera) {
  SpoiledSession session;
  for (const char* camera : {"cam0", "cam1", "cam2", "cam3"}) {
    const bool first = std::string(camera) == "cam0";
    copy_with_blanks(
        SpoiledSession::sample_video("calib", camera),
        session.new_video("calib", camera),
        [first](int frame) { return frame < 4 ? !first : (frame % 2 == 0) == first; });
  }
  session.replace_in_trial("floor", "cam0 = \"calib/cam0.mp4\", ", "");
  EXPECT_TRUE(declines(session,
                       session.run("calibrate"),
                       {"session.toml: ",
                        "{cam0} sees the board at the same time as a camera of "
                        "{cam1, cam2, cam3}",
                        "record the calibration again"}));
}

TEST(BadCalibration, IsReportedBySolveWithTheCommandToRun) {
  const SpoiledSession session;
  EXPECT_TRUE(declines(session,
                       session.run("solve"),
                       {"out/calibration.toml: ", "does not exist", "marey calibrate"}));
}

/// Returns success if the run reported poor quality: exit code 4, the results of a
/// calibration, and an error that matches `blame`.
AssertionResult is_poor(const SpoiledSession& session,
                        const ProgramRun& run,
                        const Blame& blame) {
  if (run.exit_code != 4) {
    return AssertionFailure() << "exit code " << run.exit_code << "\n" << run.err;
  }
  if (session.results() != kCalibrated) return AssertionFailure() << "other results";
  for (const std::string& error : error_lines(run.err)) {
    const std::size_t where = error.find(blame.where);
    const std::size_t cause = error.find(blame.cause);
    const std::size_t next = error.find("Next: ");
    if (where < cause && cause < next && next != std::string::npos &&
        error.find(blame.next, next) != std::string::npos) {
      return AssertionSuccess();
    }
  }
  return AssertionFailure() << run.err;
}

TEST(PoorCalibration, IsReportedByTheFewViewsAfterBriefWaving) {
  SpoiledSession session;
  session.replace_in_trial(
      "calib", "kind = \"calibration\"", "kind = \"calibration\"\nframes = [10, 30]");
  EXPECT_TRUE(is_poor(session,
                      session.run("calibrate"),
                      {"camera cam0", "at 3 instants", "wave the board longer"}));
}

TEST(PoorCalibration, IsNotReportedForTheSample) {
  const SpoiledSession session;
  const ProgramRun run = session.run("calibrate");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(session.results(), kCalibrated);
}

}  // namespace
}  // namespace marey::testing
