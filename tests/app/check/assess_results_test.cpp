// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/assess_results.h"

#include <gtest/gtest.h>

namespace marey::app {
namespace {

/// As good as real webcams allow.
Report decent() {
  Report report;
  report.calibration_rms_px = 0.8;
  report.subject_rms_px = 1.5;
  ReportTrial walk;
  walk.name = "walk";
  walk.frames = 100;
  walk.frames_solved = 98;
  walk.rms_px = 2.0;
  walk.median_px = 0.8;
  walk.cameras = {{"left", 1.9, 0.7, 4000, 0.0, ClockSource::kReference, {}},
                  {"right", 2.1, 0.9, 4000, 0.0, ClockSource::kEstimated, {}}};
  report.trials = {walk};
  return report;
}

TEST(AssessResults, PassesDecentResults) {
  EXPECT_TRUE(assess_results(decent()).empty());
  EXPECT_TRUE(assess_results(Report{}).empty());
}

TEST(AssessResults, ReportsTheCameraOfAnotherVideo) {
  Report report = decent();
  report.trials[0].rms_px = 15.2;
  report.trials[0].cameras[1].median_px = 21.6;
  const auto found = assess_results(report);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].severity, Severity::kPoor);
  EXPECT_EQ(found[0].where, "trial walk, camera right");
}

TEST(AssessResults, ReportsATrialWithoutDetections) {
  Report report = decent();
  report.trials[0].rms_px = 95.0;
  const auto found = assess_results(report);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].where, "trial walk");
}

TEST(AssessResults, ReportsUnsolvedFrames) {
  Report report = decent();
  report.trials[0].frames_solved = 89;
  const auto found = assess_results(report);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].cause, "only 89 of 100 frames could be solved");
}

TEST(AssessResults, ReportsAMisplacedTag) {
  Report report = decent();
  report.trials[0].tags = {{10, "leftFoot", {}, 0.9, 0.6, 400},
                           {11, "leftLowerLeg", {}, 14.0, 12.3, 400},
                           {12, "leftHand", {}, 80.0, 70.0, 76}};
  const auto found = assess_results(report);
  ASSERT_EQ(found.size(), 1U) << "a tag with few sightings causes no finding";
  EXPECT_EQ(found[0].severity, Severity::kPoor);
  EXPECT_EQ(found[0].where, "trial walk, tag 11");
  EXPECT_EQ(found[0].cause,
            "it is seen 12 px away from its place on segment leftLowerLeg (median; good: "
            "under 1)");
}

TEST(AssessResults, ReportsASubjectWithExchangedTags) {
  Report report = decent();
  report.subject_rms_px = 10.0;
  const auto found = assess_results(report);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].where, "subject.toml");
}

TEST(AssessResults, ReportsALargeCalibrationError) {
  Report report = decent();
  report.calibration_rms_px = 4.0;
  ASSERT_EQ(assess_results(report).size(), 1U);
}

}  // namespace
}  // namespace marey::app
