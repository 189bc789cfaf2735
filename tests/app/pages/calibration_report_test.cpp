// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/calibration_report.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/pages/calibration_html.h"
#include "app/pages/calibration_json.h"
#include "calib/quality/assess_calibration.h"
#include "calib/quality/measure_calibration.h"
#include "core/base/degrees.h"
#include "tests/app/pages/collect_keys.h"
#include "tests/app/pages/sample_calibration.h"
#include "tests/app/pages/sample_report.h"
#include "tests/support/program/paths.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

/// A camera at the origin that looks along +z, 1000 px of focal length, no distortion.
calib::CalibrationReport of_one_camera() {
  calib::CalibrationReport report;
  report.extent = calib::BoardExtent{{-0.2, -0.2, 0.0}, {0.2, 0.2, 0.0}};
  Camera camera;
  camera.intrinsics.width_px = 1280;
  camera.intrinsics.height_px = 720;
  camera.intrinsics.focal_px = {1000.0, 1000.0};
  camera.intrinsics.centre_px = {639.5, 359.5};
  report.rig.cameras = {camera};
  report.rig.quality.resize(1);
  return report;
}

/// A board that faces the camera, 2 m ahead and `x_m` to the right, seen `error_px` off.
calib::TargetView view_at(int frame, double x_m, glm::dvec2 error_px) {
  calib::TargetView view;
  view.frame = frame;
  view.target = 1;
  // Facing: its z towards the camera.
  view.world_from_target = {rotation_from_vector({kRadiansPerDegree * 180.0, 0.0, 0.0}),
                            {x_m, 0.0, 2.0}};
  calib::SeenCorner corner;
  corner.seen_px = {639.5 + 500.0 * x_m, 359.5};
  corner.error_px = error_px;
  view.corners = {corner, corner};
  return view;
}

TEST(MeasureCalibration, FindsTiltAndDistanceOfTheBoard) {
  calib::CalibrationReport report = of_one_camera();
  calib::TargetView view = view_at(0, 0.0, {});
  // Its right edge comes nearer: its face turns to the left.
  view.world_from_target.rotation =
      rotation_from_vector({0.0, 40.0 * kRadiansPerDegree, 0.0}) *
      view.world_from_target.rotation;
  report.rig.views = {view};
  const auto measured = calib::measure_cameras(report);
  ASSERT_EQ(measured[0].tilts.size(), 1U);
  EXPECT_NEAR(measured[0].tilts[0].tilt_rad, 40.0 * kRadiansPerDegree, 1e-9);
  EXPECT_NEAR(
      std::abs(measured[0].tilts[0].azimuth_rad), 180.0 * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(measured[0].tilts[0].distance_m, 2.0, 1e-9);
}

TEST(MeasureCalibration, FindsByHowMuchACameraIsLate) {
  calib::CalibrationReport report = of_one_camera();
  // A swing of half a metre in three seconds; half a frame late.
  const auto x_m = [](double frame) { return 0.5 * std::sin(0.07 * frame); };
  for (int frame = 0; frame < 90; ++frame) {
    const double error_px = 500.0 * (x_m(frame + 0.5) - x_m(frame));
    report.rig.views.push_back(view_at(frame, x_m(frame), {error_px, 0.0}));
  }
  const auto measured = calib::measure_cameras(report);
  ASSERT_TRUE(measured[0].lag);
  // Velocities are differences over two frames, which flatten a swing by 0.1 %.
  EXPECT_NEAR(measured[0].lag->frames, 0.5, 0.02);
  EXPECT_GT(measured[0].lag->explained_px, 3.0);
  report.has_clocks = true;  // Then it reports no lag.
  EXPECT_FALSE(calib::measure_cameras(report)[0].lag);
}

TEST(MeasureCalibration, FindsTheFrameFromWhichACameraFitsNoMore) {
  calib::CalibrationReport report = of_one_camera();
  for (int frame = 0; frame < 60; ++frame) {
    report.rig.views.push_back(view_at(frame, 0.01 * frame, {0.1, 0.0}));
    for (auto& corner : report.rig.views.back().corners) corner.is_outlier = frame >= 43;
  }
  const auto measured = calib::measure_cameras(report);
  ASSERT_TRUE(measured[0].mismatch_from);
  EXPECT_EQ(*measured[0].mismatch_from, 43);
  EXPECT_FALSE(measured[0].mismatch_until);
}

TEST(MeasureCalibration, SeparatesAPatternFromNoise) {
  calib::CalibrationReport report = of_one_camera();
  for (int frame = 0; frame < 60; ++frame) {
    // The first errors are half a pixel to the right for every place of the board. The
    // second alternate between right and left.
    report.rig.views.push_back(view_at(frame, 0.3 * std::sin(frame), {0.5, 0.0}));
  }
  EXPECT_NEAR(calib::measure_cameras(report)[0].pattern_px, 0.5, 0.01);
  for (auto& view : report.rig.views) {
    for (auto& corner : view.corners) {
      corner.error_px.x = view.frame / 2 % 2 == 0 ? 0.5F : -0.5F;
    }
  }
  EXPECT_LT(calib::measure_cameras(report)[0].pattern_px, 0.15);
}

TEST(CalibrationReport, HasOnlyNotesForAGoodRecording) {
  const calib::CalibrationReport& report = sample_calibration();
  for (const Finding& finding : report.findings) {
    EXPECT_EQ(finding.severity, Severity::kNote) << finding.message();
  }
  EXPECT_TRUE(report.has_floor);
  EXPECT_FALSE(report.has_clocks);
}

TEST(CalibrationReport, CountsEveryCornerOnce) {
  const calib::CalibrationReport& report = sample_calibration();
  for (std::size_t c = 0; c < report.cameras.size(); ++c) {
    const auto& cells = report.cameras[c].cells;
    EXPECT_EQ(std::accumulate(cells.begin(), cells.end(), 0),
              report.rig.quality[c].corners);
    const auto& halves = report.cameras[c].half_coverage;
    EXPECT_NEAR(0.5 * (halves[0] + halves[1]), report.rig.quality[c].coverage, 1e-9);
    EXPECT_NEAR(0.5 * (halves[2] + halves[3]), report.rig.quality[c].coverage, 1e-9);
  }
}

/// Returns the intersection of the found cameras' rays through the true pixels of a
/// point.
glm::dvec3 meeting_of(const std::vector<Camera>& found,
                      const std::vector<Camera>& truth,
                      const glm::dvec3& p_in_world) {
  glm::dmat3 across_all(0.0);
  glm::dvec3 pull(0.0);
  for (std::size_t c = 0; c < found.size(); ++c) {
    const auto pixel = project(truth[c], p_in_world);
    const auto ray = pixel ? unproject(found[c].intrinsics, *pixel) : std::nullopt;
    if (!ray) continue;
    const RigidTransform world_from_camera = inverse(found[c].camera_from_world);
    const glm::dvec3 way =
        glm::normalize(world_from_camera.rotation * glm::dvec3(ray->x, ray->y, 1.0));
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(way, way);
    across_all += across;
    pull += across * world_from_camera.translation;
  }
  return glm::inverse(across_all) * pull;
}

// Proves that the map's figure is of the size of true errors; how its sigma is made up is
// tests/calib/model/expected_error_test.cpp's.
TEST(CalibrationReport, ExpectsErrorsOfTheSizeThatPointsHave) {
  const calib::CalibrationReport& report = sample_calibration();
  const auto truth = sample_cameras();
  ASSERT_TRUE(report.map.middle_error_m);
  EXPECT_LT(
      glm::length(glm::dvec2(report.map.middle_in_world.x, report.map.middle_in_world.z)),
      0.3 /* m; the ring looks at the origin */);
  for (const double height_m : {0.3, 0.9, 1.4}) {
    const glm::dvec3 p{report.map.middle_in_world.x, height_m, 0.0};
    const double error_m = glm::distance(meeting_of(report.rig.cameras, truth, p), p);
    // Three times the root mean square: one in a thousand is more.
    EXPECT_LT(error_m, 3.0 * *report.map.middle_error_m) << height_m;
  }
  EXPECT_LT(*report.map.middle_error_m, 0.008);
  EXPECT_GT(*report.map.middle_error_m, 1e-4);
}

TEST(CalibrationReport, HasAllItsKeysOnTheFormatsPage) {
  const std::string section = marey::testing::formats_page("calibration");
  std::set<std::string> keys;
  collect_keys(calibration_json(rich_calibration()), keys);
  collect_keys(calibration_json(sample_calibration()), keys);
  EXPECT_GT(keys.size(), 60U);
  for (const std::string& key : keys) {
    EXPECT_NE(section.find('`' + key + '`'), std::string::npos) << key;
  }
}

TEST(CalibrationReport, GivesEveryParameterItsSigma) {
  const Json figures = calibration_json(rich_calibration());
  for (const Json& camera : figures.at("cameras")) {
    // Nine of the lens, six of the pose, three of the clock.
    ASSERT_EQ(camera.at("parameters").size(), 18U);
    for (const Json& parameter : camera.at("parameters")) {
      EXPECT_GT(parameter.at("sigma").get<double>(), 0.0) << parameter;
    }
  }
}

TEST(CalibrationReport, IsTheSameEveryTime) {
  EXPECT_EQ(calibration_json_text(sample_calibration()),
            calibration_json_text(sample_calibration()));
  EXPECT_EQ(calibration_html(rich_calibration()), calibration_html(rich_calibration()));
}

}  // namespace
}  // namespace marey::app
