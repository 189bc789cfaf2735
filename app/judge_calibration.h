// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/calibration_report.h"
#include "core/result.h"

namespace marey::app {

/// What to do better, and why; worst first. Reads everything of the report but its
/// findings.
[[nodiscard]] std::vector<Finding> judge_calibration(const CalibrationReport& report);

/// In a word: "good", "fair" or "look closer".
[[nodiscard]] const char* verdict_of(const CalibrationReport& report);

/// What makes a calibration too poor to be trusted, each kQuality with camera, figure and
/// remedy. Empty when it can be used.
[[nodiscard]] std::vector<Error> poor_of(const CalibrationReport& report);

/// The findings that are fair, as one line each.
[[nodiscard]] std::vector<std::string> warnings_of(const CalibrationReport& report);

}  // namespace marey::app
