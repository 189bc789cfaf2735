// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/calibration_report.h"
#include "core/camera.h"

namespace marey::app {

inline const AprilGrid kSampleBoard{6, 6, 0.1, 0.03, 0, 0.005};

/// Four cameras around 2 m (tests/support/simulation/synthetic_rig.h), calibrated from
/// sixty frames with a fifth of a pixel of noise: as good as people get. Made once.
[[nodiscard]] const calib::CalibrationReport& sample_calibration();

/// The truth that it was made from.
[[nodiscard]] std::vector<Camera> sample_cameras();

/// The same with everything that a page can show: outliers, clocks, a warp, frames held
/// out, findings of every severity, and names that would like to be markup.
[[nodiscard]] calib::CalibrationReport rich_calibration();

}  // namespace marey::app
