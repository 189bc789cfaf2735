// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "recordings/session/session.h"
#include "tests/recordings/session_text.h"

namespace marey::recordings {
namespace {

/// Returns kSession with a [calibration] of this text.
std::string asking(const std::string& text) {
  return with("[board]\n", "[calibration]\n" + text + "[board]\n");
}

TEST(SessionCalibration, HasItsDefaults) {
  const auto session = read(kSession);
  ASSERT_TRUE(session) << session.error().message();
  const CalibrationChoices& choices = session->calibration;
  EXPECT_EQ(choices.lens, LensModel::kBrownConrady);
  EXPECT_EQ(choices.clocks, ClockChoice::kAuto);
  EXPECT_TRUE(choices.cross_validate);
  EXPECT_FALSE(choices.line_delays || choices.warp || choices.lenses);
}

TEST(SessionCalibration, ReadsEveryKey) {
  const auto session =
      read(asking("lens = \"fisheye\"\nclocks = \"drifts\"\nmost_offset_s = 12\n"
                  "line_delays = true\nwarp = true\ncross_validate = false\n"
                  "lenses = \"../old/calibration.toml\"\nlowest_corner_m = 0.08\n"));
  ASSERT_TRUE(session) << session.error().message();
  const CalibrationChoices& choices = session->calibration;
  EXPECT_EQ(choices.lens, LensModel::kFisheye);
  EXPECT_EQ(choices.clocks, ClockChoice::kDrifts);
  EXPECT_EQ(choices.max_offset_s, 12.0);
  EXPECT_TRUE(choices.line_delays && choices.warp);
  EXPECT_FALSE(choices.cross_validate);
  ASSERT_TRUE(choices.lenses);
  EXPECT_EQ(*choices.lenses,
            session->file.parent_path().parent_path() / "old/calibration.toml");
  EXPECT_EQ(choices.lowest_corner_m, 0.08);
}

TEST(SessionCalibration, LeavesTheLensOpen) {
  const auto session = read(asking("lens = \"auto\"\n"));
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_FALSE(session->calibration.lens);
}

TEST(SessionCalibration, DeclinesWordsThatItDoesNotKnow) {
  EXPECT_EQ(mistake(asking("lens = \"fish-eye\"\n")),
            "session.toml:19: unknown lens \"fish-eye\". Next: perhaps you mean "
            "\"fisheye\".");
  EXPECT_EQ(mistake(asking("clocks = \"offset\"\n")),
            "session.toml:19: unknown clocks \"offset\". Next: perhaps you mean "
            "\"offsets\".");
  EXPECT_TRUE(mistake(asking("rolling_shutter = true\n"))
                  .starts_with("session.toml:19: unknown key \"rolling_shutter\""));
  EXPECT_TRUE(mistake(asking("warp = 1\n")).starts_with("session.toml:19: "));
  EXPECT_TRUE(mistake(asking("most_offset_s = 600\n")).starts_with("session.toml:19: "));
}

TEST(SessionCalibration, DeclinesOptionsThatAWandCannotDetermine) {
  const std::string board =
      "[board]\ntype = \"aprilgrid\"\nrows = 6\ncolumns = 5\ntag_size_m = 0.1\n"
      "gap_m = 0.03\nfirst_id = 0\nthickness_m = 0.005\n";
  const std::string wand = "[[wand.tag]]\nid = 3\nsize_m = 0.1\n[calibration]\n";
  for (const char* choice : {"lens = \"rational\"\n",
                             "lens = \"auto\"\n",
                             "clocks = \"offsets\"\n",
                             "clocks = \"drifts\"\nline_delays = true\n"}) {
    EXPECT_TRUE(read(with(board, wand + choice))) << choice;
  }
  EXPECT_NE(mistake(with(board, wand + "warp = true\n"))
                .find("a wand cannot determine the board's \"warp\""),
            std::string::npos);
}

// A subject who stands still determines the floor.
TEST(SessionCalibration, NeedsNoFloorTrialWithAStaticTrial) {
  std::string text = with("kind = \"floor\"", "kind = \"static\"");
  const auto session = read(text);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->find(TrialKind::kFloor), nullptr);
}

}  // namespace
}  // namespace marey::recordings
