// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Calibrations that are impossible: the filmed board differs from the declared one, or
// too few views show it. Each run reports one error with the cause, and writes no
// calibration.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/app/process/painted_session.h"
#include "tests/support/files/text_file.h"

namespace marey::testing {
namespace {

using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;

/// Returns success if the run reported one error that contains these words in this order,
/// and wrote no cameras.
AssertionResult declines_board(const PaintedSession& session,
                               const std::vector<std::string>& words) {
  const ProgramRun run = session.calibrate();
  if (run.exit_code != 3) {
    return AssertionFailure() << "exit code " << run.exit_code << "\n" << run.err;
  }
  const std::size_t error = run.err.find("error: ");
  if (error == std::string::npos ||
      run.err.find("error: ", error + 1) != std::string::npos) {
    return AssertionFailure() << "not one error\n" << run.err;
  }
  std::size_t at = error;
  for (const std::string& word : words) {
    at = run.err.find(word, at);
    if (at == std::string::npos) {
      return AssertionFailure() << "\"" << word << "\" is not in its place in\n"
                                << run.err;
    }
  }
  if (session.has_result("calibration.toml")) return AssertionFailure() << "has cameras";
  return AssertionSuccess();
}

void leave_grey(cv::Mat& picture) {
  picture.setTo(cv::Scalar(120));
}

void mirror(cv::Mat& picture, int /*frame*/) {
  cv::flip(picture, picture, /*flipCode=*/1);
}

// --- The declared board is the filmed one: the program calibrates
// ------------------------

AssertionResult calibrates(const PaintedSession& session) {
  const ProgramRun run = session.calibrate();
  // A poor calibration counts as a calibration: the pictures are few.
  if ((run.exit_code != 0 && run.exit_code != 4) ||
      !session.has_result("calibration.toml")) {
    return AssertionFailure() << "exit code " << run.exit_code << "\n" << run.err;
  }
  return AssertionSuccess();
}

TEST(GoodBoard, CalibratesForEveryKind) {
  PaintedSession charuco(charuco_table());
  charuco.film(painted_charuco());
  EXPECT_TRUE(calibrates(charuco));
  PaintedSession chessboard(chessboard_table());
  chessboard.film(painted_chessboard());
  EXPECT_TRUE(calibrates(chessboard));
  PaintedSession grid(april_grid_table());
  grid.film(painted_april_grid());
  EXPECT_TRUE(calibrates(grid));
}

// A search in a few frames only can miss the board and find only the tags.
TEST(GoodBoard, CalibratesWhenSeldomSeenAmongTags) {
  PaintedSession session(chessboard_table());
  session.film(painted_chessboard(), 48);
  const auto hide_mostly = [](cv::Mat& picture, int frame) {
    if (frame % 8 >= 3) leave_grey(picture);
    paint_worn_tags(picture);
  };
  session.change_all(hide_mostly);
  EXPECT_TRUE(calibrates(session));
}

// --- Another board
// ----------------------------------------------------------------------

TEST(BadBoard, IsReportedByVideoWhenNeverSeen) {
  for (const std::string& table :
       {charuco_table(), chessboard_table(), april_grid_table()}) {
    PaintedSession session(table);
    session.film(painted_charuco(), 4);
    session.change_all([](cv::Mat& picture, int) { leave_grey(picture); });
    EXPECT_TRUE(
        declines_board(session, {"seen0", "seen in its 4 frames", "Next: check"}));
  }
}

TEST(BadBoard, IsReportedWithItsActualDictionary) {
  PaintedSession session(replace_first(charuco_table(), "DICT_5X5_100", "DICT_4X4_50"));
  session.film(painted_charuco());
  EXPECT_TRUE(declines_board(session,
                             {"seen0",
                              "no ChArUco board of 8 x 6 squares (DICT_4X4_50) is seen",
                              "of DICT_5X5_50 are",
                              "Next: ",
                              "dictionary = \"DICT_5X5_50\""}));
}

TEST(BadBoard, IsDetectedWhenSquaresReplaceTagsDespiteABodyInView) {
  PaintedSession session(april_grid_table());
  session.film(painted_charuco());
  session.change_all([](cv::Mat& picture, int) { paint_worn_tags(picture); });
  EXPECT_TRUE(declines_board(session,
                             {"seen0",
                              "no tag of the AprilGrid",
                              "of DICT_5X5_50 are",
                              "Next: ",
                              "type = \"charuco\""}));
}

TEST(BadBoard, IsDetectedWhenTagsReplaceSquaresDespiteABodyInView) {
  for (const std::string& table : {charuco_table(), chessboard_table()}) {
    PaintedSession session(table);
    session.film(painted_april_grid());
    session.change_all([](cv::Mat& picture, int) { paint_worn_tags(picture); });
    EXPECT_TRUE(declines_board(
        session,
        {"seen0", " of DICT_APRILTAG_36h11 are", "Next: ", "type = \"aprilgrid\""}));
  }
}

TEST(BadBoard, IsDetectedWhenMarkersReplaceAChessboard) {
  PaintedSession session(chessboard_table());
  session.film(painted_charuco());
  EXPECT_TRUE(declines_board(
      session,
      {"no chessboard of 9 x 6 squares is seen", "of DICT_5X5_50 are", "\"charuco\""}));
}

TEST(BadBoard, IsDetectedWhenAChessboardReplacesACharuco) {
  PaintedSession session(charuco_table());
  session.film(painted_chessboard());
  EXPECT_TRUE(declines_board(session,
                             {"a chessboard of 9 x 6 squares is",
                              "Next: ",
                              "type = \"chessboard\", columns = 9 and rows = 6"}));
}

TEST(BadBoard, IsDetectedWithOtherRowsAndColumns) {
  PaintedSession turned(
      replace_first(replace_first(charuco_table(), "rows = 6", "rows = 8"),
                    "columns = 8",
                    "columns = 6"));
  turned.film(painted_charuco());
  EXPECT_TRUE(
      declines_board(turned, {"in other places than on it", "Next: correct rows"}));
  PaintedSession corners(
      replace_first(replace_first(chessboard_table(), "rows = 6", "rows = 5"),
                    "columns = 9",
                    "columns = 8"));
  corners.film(painted_chessboard());
  EXPECT_TRUE(declines_board(corners,
                             {"no chessboard of 8 x 5 squares is seen",
                              "a chessboard of 9 x 6 squares is",
                              "squares are counted, not their corners"}));
  PaintedSession grid(
      replace_first(replace_first(april_grid_table(), "rows = 3", "rows = 4"),
                    "columns = 4",
                    "columns = 3"));
  grid.film(painted_april_grid());
  EXPECT_TRUE(declines_board(grid,
                             {"are arranged as on a board of 4 x 3",
                              "[board]",
                              "Next: ",
                              "columns = 4, rows = 3"}));
}

TEST(BadBoard, IsDetectedWithOtherTagIds) {
  PaintedSession session(april_grid_table());
  session.film(painted_april_grid(100));
  EXPECT_TRUE(
      declines_board(session, {"seen0", "no tag of the ", "ids 0 to 11", "Next: "}));
}

TEST(BadBoard, IsDetectedWhenMirrored) {
  PaintedSession charuco(charuco_table());
  charuco.film(painted_charuco());
  charuco.change_all(mirror);
  EXPECT_TRUE(declines_board(charuco, {"mirrored", "Next: record without mirroring"}));
  PaintedSession grid(april_grid_table());
  grid.film(painted_april_grid());
  grid.change_all(mirror);
  EXPECT_TRUE(declines_board(grid, {"mirrored", "Next: switch off mirroring"}));
}

// --- Too few views of the board
// -------------------------------------------------------------------

TEST(BadViews, ThatAreTooFewAreCounted) {
  for (const auto& [table, board] :
       {std::pair{charuco_table(), painted_charuco()},
        std::pair{chessboard_table(), painted_chessboard()},
        std::pair{april_grid_table(), painted_april_grid()}}) {
    PaintedSession session(table);
    session.film(board);
    session.change(1, [](cv::Mat& picture, int frame) {
      if (frame != 3 && frame != 9) leave_grey(picture);
    });
    EXPECT_TRUE(declines_board(session, {"seen1", "2 frames", "Next: "}));
  }
}

TEST(BadViews, AreReportedWhenAllAlike) {
  for (const auto& [table, board] :
       {std::pair{charuco_table(), painted_charuco()},
        std::pair{chessboard_table(), painted_chessboard()},
        std::pair{april_grid_table(), painted_april_grid()}}) {
    PaintedSession session(table);
    session.film(board, 16, [](int frame) { return 2.0 + 0.002 * frame; });
    const ProgramRun run = session.calibrate();
    EXPECT_EQ(run.exit_code, 4) << run.err;
    EXPECT_NE(run.err.find("error: calibration, all cameras: the expected error of a "
                           "point in the middle of the volume is "),
              std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("Next: show the board longer, nearer and more tilted"),
              std::string::npos);
  }
}

TEST(BadViews, ThatNoTwoGroupsShareNameTheGroups) {
  for (const auto& [table, board] :
       {std::pair{charuco_table(), painted_charuco()},
        std::pair{chessboard_table(), painted_chessboard()},
        std::pair{april_grid_table(), painted_april_grid()}}) {
    PaintedSession session(table);
    session.film(board, 24);
    for (int camera = 0; camera < 3; ++camera) {
      session.change(camera, [camera](cv::Mat& picture, int frame) {
        if ((camera == 0) != (frame % 2 == 0)) leave_grey(picture);
      });
    }
    EXPECT_TRUE(
        declines_board(session,
                       {"{cam0} sees the board at the same time as a camera of {cam1, "
                        "cam2}",
                        "Next: "}));
  }
}

// A mirrored chessboard is a chessboard still: only the other cameras contradict it.
TEST(BadViews, AreDeclinedWhenOneCameraMirrors) {
  PaintedSession session(chessboard_table());
  session.film(painted_chessboard());
  session.change(1, mirror);
  EXPECT_TRUE(declines_board(
      session, {"session.toml: ", "the error of the calibration is ", "Next: check"}));
}

TEST(BadFloor, IsReportedWhenItsBoardLiesFaceDown) {
  for (const auto& [table, board] :
       {std::pair{charuco_table(), painted_charuco()},
        std::pair{april_grid_table(), painted_april_grid()}}) {
    PaintedSession session(table);
    session.film(board);
    session.add_floor([](cv::Mat& picture) { mirror(picture, 0); });
    EXPECT_TRUE(declines_board(session, {"floor", "mirrored"}));
    session.add_floor(leave_grey);
    EXPECT_TRUE(declines_board(session, {"floor", "Next: "}));
  }
}

}  // namespace
}  // namespace marey::testing
