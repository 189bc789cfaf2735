// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/quality/calibration_report.h"

namespace marey::calib {

/// Returns the findings of a calibration, worst first. Reads all of the report except its
/// findings.
[[nodiscard]] std::vector<Finding> assess_calibration(const CalibrationReport& report);

/// Returns the verdict: "good", "fair" or "look closer".
[[nodiscard]] const char* verdict_of(const CalibrationReport& report);

}  // namespace marey::calib
