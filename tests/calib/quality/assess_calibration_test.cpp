// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/assess_calibration.h"

#include <gtest/gtest.h>

#include "tests/calib/quality/calibration_findings.h"

namespace marey::calib {
namespace {

using testing::decent;
using testing::expect;
using testing::only;

TEST(AssessCalibration, FindsNoFaultInAGoodRig) {
  const CalibrationReport report = decent();
  EXPECT_TRUE(assess_calibration(report).empty());
  EXPECT_STREQ(verdict_of(report), "good");
}

TEST(AssessCalibration, NamesTheHalfThatWasNotShown) {
  CalibrationReport report = decent();
  report.cameras[0].half_coverage = {0.9, 0.1, 0.5, 0.5};
  expect(
      only(report), Severity::kFair, "coverage", "camera left", "10 % of the right half");
}

TEST(AssessCalibration, NamesACameraThatSawLittle) {
  CalibrationReport report = decent();
  report.rig.quality[1].coverage = 0.2;
  expect(only(report), Severity::kFair, "coverage", "camera middle", "20 %");
  report.rig.quality[1].coverage = 0.04;
  expect(only(report), Severity::kPoor, "coverage", "camera middle", "4 %");
}

TEST(AssessCalibration, MergesFindingsOfSeveralCameras) {
  CalibrationReport report = decent();
  report.rig.quality[0].coverage = 0.2;
  report.rig.quality[2].coverage = 0.25;
  const Finding found = only(report);
  EXPECT_EQ(found.where, "cameras left (20 %), right (25 %)");
}

TEST(AssessCalibration, NamesABoardThatWasHardlyTilted) {
  CalibrationReport report = decent();
  report.cameras[2].p90_tilt_rad = 0.1;
  expect(only(report), Severity::kFair, "tilt", "camera right", "6 degrees");
  report.cameras[2].tilts.clear();  // A wand has no face.
  EXPECT_TRUE(assess_calibration(report).empty());
}

TEST(AssessCalibration, NamesCamerasThatHardlyMeet) {
  CalibrationReport report = decent();
  // Left and right need no shared views: the middle connects them. Now it does so weakly.
  report.rig.shared_views = {40, 30, 2, 30, 40, 3, 2, 3, 40};
  expect(
      only(report), Severity::kFair, "shared", "cameras middle and right", "3 instants");
}

TEST(AssessCalibration, ReportsThreeViewsAsPoor) {
  CalibrationReport report = decent();
  report.cameras[1].instants = 3;
  expect(only(report), Severity::kPoor, "views", "camera middle", "at 3 instants");
}

TEST(AssessCalibration, NamesTheCameraThatIsWorseThanTheOthers) {
  CalibrationReport report = decent();
  report.cameras[2].inlier_rms_px = 1.2;
  expect(only(report), Severity::kFair, "worse", "camera right", "1.20 px");
  report.cameras[2].inlier_rms_px = 3.5;
  expect(only(report), Severity::kPoor, "worse", "camera right", "3.50 px");
}

TEST(AssessCalibration, TakesThePicturesSizeIntoAccount) {
  CalibrationReport report = decent();
  for (std::size_t c = 0; c < 3; ++c) {
    report.rig.cameras[c].intrinsics.width_px = 3840;
    report.cameras[c].inlier_rms_px = 0.9;
  }
  EXPECT_TRUE(assess_calibration(report).empty());
}

TEST(AssessCalibration, NamesLineDelaysOfARollingShutter) {
  CalibrationReport report = decent();
  report.rig.apparent_line_delays = ApparentLineDelays{
      {40e-6, 42e-6, 1e-6}, {2e-7, 2e-7, 2e-7}, {0.02, 0.03, 0.001}, 20000.0};
  const Finding found = only(report);
  expect(found,
         Severity::kPoor,
         "rolling-shutter",
         "cameras left (29 ms), middle (30 ms)",
         "shift by up to 30 mm");
  EXPECT_NE(found.next.find("line_delays = true"), std::string::npos);
  // A rolling shutter has a small apparent move, and a move a small apparent line delay.
  report.rig.apparent_move =
      ApparentMove{CameraId{1}, 77, 3.8, 0.0042, 0.003, 9000.0, {}};
  EXPECT_EQ(only(report).id, "rolling-shutter");
  report.rig.apparent_move->gain = 50000.0;
  EXPECT_EQ(only(report).id, "moved");
}

TEST(AssessCalibration, NamesACameraWithAnAmbiguousPose) {
  CalibrationReport report = decent();
  report.rig.ambiguous = AmbiguousCamera{CameraId{2}, 2, 0.8, 0.21, 0.24};
  expect(only(report), Severity::kPoor, "ambiguous", "camera right", "0.80 m away");
}

TEST(AssessCalibration, NamesACameraWhoseHalvesInTimeDisagree) {
  CalibrationReport report = decent();
  CrossValidation check{0.3,
                        0.32,
                        {0.002, 0.002, 0.002},
                        {0.0, 0.0, 0.0},
                        {0.0, 0.0, 0.0},
                        {0.005, 0.045, 0.005},
                        {0.006, 0.006, 0.006},
                        {0.3, 0.3, 0.3}};
  report.rig.cross_validation = check;
  expect(only(report), Severity::kPoor, "halves", "camera middle", "45 mm");
  report.rig.cross_validation->time_apart_m[1] = 0.015;
  expect(only(report), Severity::kFair, "halves", "camera middle", "15 mm");
  report.rig.cross_validation->time_apart_m[1] = 0.011;
  EXPECT_TRUE(assess_calibration(report).empty());
}

TEST(AssessCalibration, NamesACameraThatIsOutOfStepAndBlamesNothingElse) {
  CalibrationReport report = decent();
  report.cameras[1].lag = CameraLag{0.6, 0.02, 1.5};
  report.cameras[1].mismatch_until = 30;
  expect(only(report), Severity::kFair, "clock", "camera middle", "20 ms or more later");
}

TEST(AssessCalibration, NamesTheWandWithoutABoard) {
  CalibrationReport report = decent();
  report.extent.reset();
  for (auto& camera : report.cameras) {
    camera.tilts.clear();
    camera.floor_median_px.reset();
  }
  report.cameras[0].mismatch_from = 71;
  report.cameras[1].pattern_px = 0.32;
  report.cameras[1].lag = CameraLag{0.6, 0.02, 1.5};
  report.rig.quality[2].coverage = 0.2;
  report.rig.outlier_frames = {{CameraId{0}, kFloorInstant, 9, 10, 9.0},
                               {CameraId{1}, kFloorInstant, 9, 10, 9.0}};
  report.rig.cross_validation = CrossValidation{0.3,
                                                0.32,
                                                {0.002, 0.002, 0.002},
                                                {0.0, 0.0, 0.0},
                                                {0.0, 0.0, 0.0},
                                                {},
                                                {},
                                                {0.3, 0.3, 7.0}};
  const auto found = assess_calibration(report);
  EXPECT_EQ(found.size(), 6U);
  for (const Finding& finding : found) {
    EXPECT_EQ((finding.where + finding.cause + finding.next).find("board"),
              std::string::npos)
        << finding.where << ": " << finding.cause << ": " << finding.next;
    if (finding.id == "outlier-frame") {
      EXPECT_EQ(finding.where, "scenery");
    }
  }
}

TEST(AssessCalibration, NamesACameraThatGoesOutOfStepOnItsWay) {
  CalibrationReport report = decent();
  report.cameras[1].slip = CameraSlip{40, 0.9, 5.0};
  expect(only(report), Severity::kPoor, "slip", "camera middle", "from frame 40 on");
  report.cameras[1].slip->moved_px = 0.1;
  EXPECT_TRUE(assess_calibration(report).empty());
}

TEST(AssessCalibration, ReportsImplausibleLineDelaysAndDrifts) {
  CalibrationReport report = decent();
  report.rig.clocks.resize(3);
  report.rig.clocks[1] = {0.0, 1e-4, 2e-4, 1e-5, 40e-6, 1e-6};
  EXPECT_TRUE(assess_calibration(report).empty());
  // 720 rows of 200 us each, 30 times a second.
  report.rig.clocks[1].line_delay_s = 200e-6;
  expect(only(report), Severity::kPoor, "line-delay", "camera middle", "144 ms");
  report.rig.clocks[1].line_delay_s = -20e-6;
  expect(only(report), Severity::kFair, "line-delay", "camera middle", "-20 us");
  report.rig.clocks[1].line_delay_s = 0.0;
  report.rig.clocks[1].drift = 3e-3;
  expect(only(report), Severity::kPoor, "drift", "camera middle", "3000 ppm");
}

TEST(AssessCalibration, CountsOutliers) {
  CalibrationReport report = decent();
  report.cameras[0].outlier_corners = 600;
  expect(only(report), Severity::kFair, "outliers", "camera left", "15 %");
  report.cameras[0].outlier_corners = 2000;
  expect(only(report), Severity::kPoor, "outliers", "camera left", "50 %");
}

TEST(AssessCalibration, SeesALensThatItsModelDoesNotFit) {
  CalibrationReport report = decent();
  report.cameras[0].pattern_px = 0.32;
  report.cameras[0].inlier_rms_px = 0.45;
  expect(only(report), Severity::kFair, "lens", "camera left", "0.32 px");
}

TEST(AssessCalibration, ReportsLargePointErrors) {
  CalibrationReport report = decent();
  report.map.middle_error_m = 0.03;
  expect(only(report), Severity::kPoor, "error", "all cameras", "30.0 mm");
  // In a hall of nine metres, the relative error is a third of it.
  report.map.distance_m = 9.0;
  expect(only(report), Severity::kFair, "error", "all cameras", "30.0 mm");
}

TEST(AssessCalibration, LocatesLargeErrors) {
  CalibrationReport report = decent();
  for (auto& place : report.map.places) {
    if (place.p_in_world.x > 0.4) place.error_m = 0.05;
  }
  expect(only(report), Severity::kFair, "volume", "all cameras", "towards +x");
}

TEST(AssessCalibration, ReportsLargeHeldOutErrors) {
  CalibrationReport report = decent();
  CrossValidation check{0.3,
                        0.32,
                        {0.002, 0.002, 0.002},
                        {0.0, 0.0, 0.0},
                        {0.0, 0.0, 0.0},
                        {},
                        {},
                        {0.3, 0.3, 0.3}};
  report.rig.cross_validation = check;
  EXPECT_TRUE(assess_calibration(report).empty());
  report.rig.cross_validation->held_out_rms_px = 1.5;
  expect(only(report), Severity::kPoor, "held-out", "all cameras", "1.50 px");
  report.rig.cross_validation = check;
  report.rig.cross_validation->held_out_camera_px[1] = 7.0;
  expect(only(report), Severity::kPoor, "held-out", "camera middle", "7.0 px");
  report.rig.cross_validation = check;
  report.rig.cross_validation->centre_apart_m[2] = 0.025;
  expect(only(report), Severity::kFair, "halves", "camera right", "25 mm");
  report.rig.cross_validation->centre_apart_m[2] = 0.05;
  expect(only(report), Severity::kPoor, "halves", "camera right", "50 mm");
  // The camera's own sigma explains the difference.
  report.rig.quality[2].centre_sigma_m = 0.02;
  EXPECT_TRUE(assess_calibration(report).empty());
}

TEST(AssessCalibration, GradesProblemsAsPoorOrFair) {
  CalibrationReport report = decent();
  report.cameras[0].mismatch_from = 71;
  report.rig.quality[1].coverage = 0.2;
  report.findings = assess_calibration(report);
  EXPECT_STREQ(verdict_of(report), "look closer");
  ASSERT_EQ(report.findings.size(), 2U);
  EXPECT_EQ(report.findings[0].severity, Severity::kPoor);
  EXPECT_EQ(report.findings[0].where, "camera left");
  EXPECT_EQ(report.findings[1].severity, Severity::kFair);
}

TEST(AssessCalibration, MergesWrongSquareSizesOfAllCameras) {
  CalibrationReport report = decent();
  // Glare in one camera does not indicate a wrong print.
  report.rig.cameras[0].tag_shrinkage.slope = 0.02;
  EXPECT_TRUE(assess_calibration(report).empty());
  for (Camera& camera : report.rig.cameras) camera.tag_shrinkage.slope = -0.023;
  const Finding swollen = only(report);
  EXPECT_EQ(swollen.id, std::string("print"));
  EXPECT_EQ(swollen.severity, Severity::kPoor);
  EXPECT_NE(swollen.cause.find("2.3 % larger"), std::string::npos) << swollen.cause;
  for (Camera& camera : report.rig.cameras) camera.tag_shrinkage.slope = 0.01;
  const Finding shrunk = only(report);
  EXPECT_EQ(shrunk.severity, Severity::kFair);
  EXPECT_NE(shrunk.cause.find("1.0 % smaller"), std::string::npos) << shrunk.cause;
}

}  // namespace
}  // namespace marey::calib
