// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Sessions with common mistakes: exchanged videos and segments, wrong figures, missing
// recordings. Each message names what to change.
#include <string>

#include <gtest/gtest.h>

#include "tests/app/blame.h"
#include "tests/app/spoiled_session.h"

namespace marey::testing {
namespace {

const std::vector<std::string> kCalibratedArguments{
    "calibration.html", "calibration.json", "calibration.toml"};

bool prints(const ProgramRun& run, const std::string& words) {
  return run.err.find(words) != std::string::npos;
}

/// Exchanges every "left" and "right" in the segments of the tags.
void exchange_sides(SpoiledSession& session) {
  session.replace("segment = \"left", "segment = \"LEFT");
  session.replace("segment = \"right", "segment = \"left");
  session.replace("segment = \"LEFT", "segment = \"right");
}

TEST(MistakenSession, WithLeftAndRightExchangedIsDeclined) {
  SpoiledSession session;
  exchange_sides(session);
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml: [[tags.tag]]",
                        "left and right look exchanged on the arms and legs",
                        "exchange left and right"},
                       kCalibratedArguments));
}

TEST(MistakenSession, WithForearmsExchangedIsDeclinedByTheirNames) {
  SpoiledSession session;
  session.replace("segment = \"leftLowerArm\"", "segment = \"LOWERARM\"");
  session.replace("segment = \"rightLowerArm\"", "segment = \"leftLowerArm\"");
  session.replace("segment = \"LOWERARM\"", "segment = \"rightLowerArm\"");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml: [[tags.tag]]",
                        "\"leftLowerArm\" and \"rightLowerArm\" look exchanged",
                        "`segment`"},
                       kCalibratedArguments));
}

TEST(MistakenSession, WithStaticAndRangeOfMotionExchangedIsDeclinedByBoth) {
  SpoiledSession session;
  session.replace_in_trial("static", "kind = \"static\"", "kind = \"KIND\"");
  session.replace_in_trial("rom", "kind = \"range-of-motion\"", "kind = \"static\"");
  session.replace_in_trial("static", "kind = \"KIND\"", "kind = \"range-of-motion\"");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml:",
                        "the subject of static trial rom does not stand still",
                        "exchange the videos of rom and static, or their `kind`"}));
}

TEST(MistakenSession, WithAWalkAsStaticTrialIsDeclinedByBothTrials) {
  SpoiledSession session;
  session.replace_in_trial("static", "kind = \"static\"", "kind = \"KIND\"");
  session.replace_in_trial("walk", "kind = \"motion\"", "kind = \"static\"");
  session.replace_in_trial("static", "kind = \"KIND\"", "kind = \"motion\"");
  EXPECT_TRUE(declines(session,
                       session.run(),
                       {"session.toml:",
                        "the subject of static trial walk does not stand still",
                        "exchange the videos of walk and static"}));
}

TEST(MistakenSession, WithMistypedIdsIsDeclinedByListedAndSeenIds) {
  SpoiledSession session;
  session.replace("id = 41\n", "id = 500\n");
  session.replace("id = 46\n", "id = 501\n");
  const ProgramRun run = session.run();
  EXPECT_TRUE(declines(session,
                       run,
                       {"session.toml: [[tags.tag]]",
                        "tags 500, 501 are listed but never seen",
                        "correct the `id`"}));
  EXPECT_TRUE(prints(run, "tags 41, 46 are often seen but not listed")) << run.err;
}

TEST(MistakenSession, WithAWrongStatureGetsAWarning) {
  SpoiledSession session;
  session.replace("stature_m = 1.734", "stature_m = 2.034");
  const ProgramRun run = session.run();
  EXPECT_TRUE(prints(run, "stature_m of [subject] is 2.03 m")) << run.err;
}

TEST(MistakenSession, WithoutTagsOnAForearmIsDeclinedBeforeAnyWork) {
  SpoiledSession session;
  session.replace("segment = \"leftLowerArm\"", "segment = \"leftHand\"");
  const ProgramRun run = session.run();
  EXPECT_TRUE(declines(
      session, run, {"session.toml: ", "on segment \"leftLowerArm\"", "glue a tag"}));
  EXPECT_FALSE(prints(run, "tags in")) << run.err;
}

TEST(MistakenSession, WithIdsBeyondItsFamilyIsDeclinedByTheFamily) {
  SpoiledSession session;
  session.replace("family = \"tag36h11\"", "family = \"tag25h9\"");
  const ProgramRun run = session.run();
  EXPECT_TRUE(
      declines(session, run, {"session.toml:", "tag25h9 ends at 34", "`family`"}));
  EXPECT_FALSE(prints(run, "tags in")) << run.err;
}

TEST(MistakenSession, WithACameraThatSeesNoBoardIsDeclinedBeforeAnyWork) {
  SpoiledSession session;
  session.replace_in_trial("calib", ", cam3 = \"calib/cam3.mp4\"", "");
  const ProgramRun run = session.run();
  EXPECT_TRUE(declines(session,
                       run,
                       {"session.toml:",
                        "camera \"cam3\" has no video in trial \"calib\"",
                        "add its video"}));
  EXPECT_FALSE(prints(run, "tags in")) << run.err;
}

TEST(MistakenSession, ReportsTagsBeyondTheDeclaredRows) {
  SpoiledSession session;
  session.replace("rows = 6\n", "rows = 5\n");
  const ProgramRun run = session.run();
  EXPECT_TRUE(prints(run, "[board]: tags 30, 31, 32, 33, 34, 35 move with the board"))
      << run.err;
}

TEST(MistakenSession, IsCalibratedBeforeItsOtherTrialsAreRecorded) {
  SpoiledSession session;
  session.replace("\"static/", "\"not-yet-static/");
  session.replace("\"rom/", "\"not-yet-rom/");
  session.replace("\"walk/", "\"not-yet-walk/");
  const ProgramRun run = session.run("calibrate");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(session.has_result("calibration.toml"));
  EXPECT_TRUE(prints(run, "trial static is not recorded yet")) << run.err;
}

}  // namespace
}  // namespace marey::testing
