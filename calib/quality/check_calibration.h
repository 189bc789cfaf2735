// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/quality/calibration_report.h"
#include "core/base/result.h"

namespace marey::calib {

/// Returns the findings of a calibration, worst first. Reads all of the report except its
/// findings.
[[nodiscard]] std::vector<Finding> check_calibration(const CalibrationReport& report);

/// Returns the verdict: "good", "fair" or "look closer".
[[nodiscard]] const char* verdict_of(const CalibrationReport& report);

/// Returns the poor findings as errors (kQuality) with camera, value and next step. Empty
/// if the calibration can be used.
[[nodiscard]] std::vector<Error> poor_of(const CalibrationReport& report);

/// Returns the fair findings, one line each.
[[nodiscard]] std::vector<std::string> warnings_of(const CalibrationReport& report);

}  // namespace marey::calib
