// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/quality/calibration_report.h"

namespace marey::calib {

/// Returns the findings of a calibration, worst first, with their limits and units:
/// print, expected error, camera faults, timing, residuals and views. Findings of one
/// cause that several cameras share are merged into one. Reads all of the report except
/// its findings. Limits in pixels apply to images up to 1920 px wide (pixel_scale()).
/// Precondition: `report.cameras`, `report.rig.cameras` and `report.rig.quality` have
/// one entry per camera, in one order. The same holds for every assess_*() of this folder
/// with its FindingCollector.
[[nodiscard]] std::vector<Finding> assess_calibration(const CalibrationReport& report);

/// Returns the verdict of `report.findings`, by the first and worst: "good" (none, or
/// notes only), "fair" or "look closer" (poor).
[[nodiscard]] const char* verdict_of(const CalibrationReport& report);

}  // namespace marey::calib
