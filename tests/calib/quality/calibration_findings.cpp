// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/calib/quality/calibration_findings.h"

#include <gtest/gtest.h>

namespace marey::testing {

using namespace calib;

CalibrationReport decent() {
  CalibrationReport report;
  report.extent = BoardExtent{};
  report.has_floor = true;
  report.rate_hz = 30.0;
  for (const char* name : {"left", "middle", "right"}) {
    Camera camera;
    camera.name = name;
    camera.intrinsics.width_px = 1280;
    camera.intrinsics.height_px = 720;
    report.rig.cameras.push_back(camera);
    CameraQuality quality;
    quality.corners = 4000;
    quality.views = 40;
    quality.coverage = 0.6;
    quality.centre_sigma_m = 0.002;
    report.rig.quality.push_back(quality);
    CameraMeasures measures;
    measures.inlier_rms_px = 0.3;
    measures.median_px = 0.2;
    measures.outlier_corners = 40;
    measures.instants = 40;
    measures.half_coverage = {0.6, 0.6, 0.6, 0.6};
    measures.tilts = {{0.7, 0.0, 2.0}};
    measures.p90_tilt_rad = 0.7;
    measures.lag = CameraLag{0.01, 0.01, 0.02};
    measures.floor_median_px = 0.3;
    report.cameras.push_back(measures);
  }
  report.rig.median_px = 0.2;
  report.rig.shared_views = {40, 30, 2, 30, 40, 25, 2, 25, 40};
  report.map.distance_m = 3.0;
  report.map.middle_error_m = 0.003;
  report.map.grid = {{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}, 0.5, {0.9}};
  report.map.height_names = {"hip"};
  for (int i = 0; i < 25; ++i) {
    report.map.places.push_back(
        {{-1.0 + 0.5 * (i % 5), 0.9, -1.0 + 0.5 * (i / 5)}, 3, 0.004});
  }
  report.map.middle_in_world = {0.0, 0.9, 0.0};
  return report;
}

Finding only(const CalibrationReport& report) {
  const auto found = assess_calibration(report);
  EXPECT_EQ(found.size(), 1U);
  return found.empty() ? Finding{} : found.front();
}

void expect(const Finding& found,
            Severity severity,
            const std::string& kind,
            const std::string& where,
            const std::string& figure) {
  EXPECT_EQ(found.severity, severity) << found.cause;
  EXPECT_EQ(found.id, kind);
  EXPECT_EQ(found.where, where);
  EXPECT_NE(found.cause.find(figure), std::string::npos) << found.cause;
  EXPECT_FALSE(found.next.empty());
}

}  // namespace marey::testing
