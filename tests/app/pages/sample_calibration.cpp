// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/pages/sample_calibration.h"

#include <stdexcept>
#include <utility>

#include "calib/quality/report_calibration.h"
#include "calib/rig/calibrate_cameras.h"
#include "tests/app/pages/sample_report.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::app {

std::vector<Camera> sample_cameras() {
  return marey::testing::ring_of_cameras();
}

const calib::CalibrationReport& sample_calibration() {
  static const calib::CalibrationReport report = [] {
    const auto cameras = sample_cameras();
    marey::testing::Disturbance noise;
    noise.noise_px = 0.2;
    const auto recording = marey::testing::wave_board(cameras, kSampleBoard, 60, noise);
    calib::CalibrateOptions options;
    options.cross_validate = true;
    auto rig = calib::calibrate_cameras(marey::testing::names_of(cameras),
                                        recording.waved,
                                        recording.floor,
                                        kSampleBoard,
                                        options);
    if (!rig) throw std::runtime_error(rig.error().message());
    const CalibrationTarget target = kSampleBoard;
    return calib::report_calibration({"sample", "1.0", &target, 1.75, 30.0, true},
                                     std::move(*rig));
  }();
  return report;
}

calib::CalibrationReport rich_calibration() {
  calib::CalibrationReport report = sample_calibration();
  report.session = kHostile;
  for (Camera& camera : report.rig.cameras) camera.name += kHostile;
  report.has_clocks = true;
  for (auto& clock : report.rig.clocks) clock = {0.01, 1e-4, 1e-5, 1e-6, 2e-5, 1e-6};
  report.rig.warp_m = {{0.002, -0.001, 0.0005}};
  for (std::size_t i = 0; i < report.rig.views.size(); i += 7) {
    for (auto& corner : report.rig.views[i].corners) corner.is_outlier = true;
  }
  report.rig.outlier_frames = {{CameraId{1}, 7, 3, 20, 9.0},
                               {CameraId{2}, calib::kFloorInstant, 1, 36, 4.0}};
  report.cameras[1].lag = calib::CameraLag{0.4, 0.01, 1.2};
  report.findings = {
      {Severity::kPoor, "error", "all cameras", kHostile, "do this"},
      {Severity::kFair, "coverage", "camera " + std::string(kHostile), "cause", "next"},
      {Severity::kNote, "warp", "board", "bent", "next"}};
  return report;
}

}  // namespace marey::app
