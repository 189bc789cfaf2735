// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "calib/quality/assess_calibration.h"
#include "tests/calib/quality/calibration_findings.h"

// Findings about moved cameras and inaccurate floors.

namespace marey::calib {
namespace {

using testing::decent;
using testing::expect;
using testing::only;

TEST(AssessCameraFaults, NamesADriftingFocusThatHardlyMovesThePicture) {
  CalibrationReport report = decent();
  ApparentMove move;
  move.camera = CameraId{1};
  move.from_frame = 44;
  move.moved_px = 0.17;
  move.rig_shift_m = 0.13;
  move.gain = 1393.0;
  report.rig.apparent_move = move;
  expect(only(report),
         Severity::kPoor,
         "unsteady",
         "camera middle",
         "shift by up to 130 mm");
  // A gain that occurs by chance, for any shift.
  move.gain = 100.0;
  report.rig.apparent_move = move;
  EXPECT_TRUE(assess_calibration(report).empty());
}

// A focal length that changes by 0.6 % shifts the image by 0.8 px and the cameras by 50
// mm.
TEST(AssessCameraFaults, GradesASmallMoveByTheShiftOfTheCameras) {
  CalibrationReport report = decent();
  ApparentMove move;
  move.camera = CameraId{1};
  move.from_frame = 46;
  move.moved_px = 0.8;
  move.gain = 15600.0;
  move.rig_shift_m = 0.003;
  report.rig.apparent_move = move;
  expect(only(report), Severity::kFair, "moved", "camera middle", "0.8 px");
  report.rig.apparent_move->rig_shift_m = 0.044;
  expect(only(report),
         Severity::kPoor,
         "moved",
         "camera middle",
         "cameras shift by up to 44 mm");
}

TEST(AssessCameraFaults, GradesASmallMoveAsFairWhereFramesAreNotSimultaneous) {
  CalibrationReport report = decent();
  ApparentMove move;
  move.camera = CameraId{1};
  move.from_frame = 32;
  move.moved_px = 1.6;
  move.gain = 1425.0;
  report.rig.apparent_move = move;
  expect(only(report), Severity::kPoor, "moved", "camera middle", "1.6 px");
  for (const std::size_t c : {0U, 2U}) report.cameras[c].outlier_corners = 600;
  ASSERT_FALSE(assess_calibration(report).empty());
  for (const Finding& finding : assess_calibration(report)) {
    EXPECT_EQ(finding.severity, Severity::kFair) << finding.cause;
  }
  report.rig.apparent_move->moved_px = 4.0;
  EXPECT_EQ(assess_calibration(report).front().severity, Severity::kPoor);
}

TEST(AssessCameraFaults, ReportsAFloorThatOnlyOneCameraSees) {
  CalibrationReport report = decent();
  report.board_on_floor = true;
  TargetView view;
  view.camera = CameraId{2};
  view.frame = kFloorInstant;
  view.stays = true;
  report.rig.views.assign(3, view);
  expect(only(report), Severity::kFair, "floor", "camera right", "no other camera");
}

TEST(AssessCameraFaults, NamesAFloorThatIsAboveTheCameras) {
  CalibrationReport report = decent();
  report.board_on_floor = true;
  report.rig.cameras[2].camera_from_world.translation = {0.0, 0.8, 0.0};
  expect(only(report), Severity::kPoor, "floor", "camera right", "0.8 m below the floor");
  report = decent();
  report.board_on_floor = true;
  TargetView view;
  view.world_from_target.translation = {0.0, -1.1, 0.0};
  report.rig.views.assign(20, view);
  view.frame = kFloorInstant;
  view.stays = true;
  for (const int c : {0, 1}) {
    view.camera = CameraId{c};
    report.rig.views.push_back(view);
  }
  expect(only(report), Severity::kPoor, "floor", "all cameras", "1.1 m below the floor");
}

TEST(AssessCameraFaults, NamesACameraThatWasMoved) {
  CalibrationReport report = decent();
  report.cameras[0].mismatch_from = 71;
  expect(only(report), Severity::kPoor, "moved", "camera left", "frame 71");
}

TEST(AssessCameraFaults, NamesACameraThatWasNudgedAndByHowMuch) {
  CalibrationReport report = decent();
  report.rig.apparent_move =
      ApparentMove{CameraId{1}, 77, 3.8, 0.0042, 0.003, 9000.0, {}};
  expect(only(report), Severity::kPoor, "moved", "camera middle", "moved by 3.8 px");
  EXPECT_NE(only(report).cause.find("from frame 77"), std::string::npos);
  // Its further consequences are not reported again.
  report.cameras[1].outlier_corners = 1500;
  report.cameras[1].slip = CameraSlip{40, 0.9, 5.0};
  EXPECT_EQ(only(report).id, "moved");
  report.rig.apparent_move->alternatives = {CameraId{2}};
  EXPECT_EQ(only(report).where, "camera middle or right");
}

TEST(AssessCameraFaults, IgnoresMovesCausedByLenses) {
  CalibrationReport report = decent();
  report.rig.apparent_move =
      ApparentMove{CameraId{1}, 77, 0.3, 0.0003, 0.001, 9000.0, {}};
  EXPECT_TRUE(assess_calibration(report).empty());
  report.rig.apparent_move = ApparentMove{CameraId{1}, 77, 3.0, 0.003, 0.001, 90.0, {}};
  EXPECT_TRUE(assess_calibration(report).empty());
}

// On 4K, half a pixel of lag is not significant: whole sections of outliers have another
// cause.
TEST(AssessCameraFaults, ReportsAMovedCameraDespiteAnInsignificantLag) {
  CalibrationReport report = decent();
  report.rig.cameras[1].intrinsics.width_px = 3840;
  report.cameras[1].lag = CameraLag{0.2, 0.01, 0.5};
  report.cameras[1].mismatch_from = 71;
  expect(only(report), Severity::kPoor, "moved", "camera middle", "frame 71");
}

TEST(AssessCameraFaults, NamesTheCameraThatTheFloorDoesNotAgreeWith) {
  CalibrationReport report = decent();
  report.cameras[2].floor_median_px = 2.5;
  expect(only(report), Severity::kFair, "floor", "camera right", "2.5 px");
}

}  // namespace
}  // namespace marey::calib
