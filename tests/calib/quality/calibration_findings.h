// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calib/quality/assess_calibration.h"
#include "calib/quality/calibration_report.h"

namespace marey::testing {

/// Returns the report of a good calibration of three webcams.
[[nodiscard]] calib::CalibrationReport decent();

/// Returns the only finding; the test fails if there are none or several.
[[nodiscard]] Finding only(const calib::CalibrationReport& report);

/// Expects a finding of this severity, kind and place, with a cause that contains the
/// figure and with a next step.
void expect(const Finding& found,
            Severity severity,
            const std::string& kind,
            const std::string& where,
            const std::string& figure);

}  // namespace marey::testing
