// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/calibration_report.h"
#include "app/judge_calibration.h"

namespace marey::testing {

/// Returns the report of a good calibration of three webcams.
[[nodiscard]] app::CalibrationReport decent();

/// Returns the one finding; the test fails if there are none or several.
[[nodiscard]] app::Finding only(const app::CalibrationReport& report);

/// Expects a finding of this severity, kind and place, with a cause that contains the
/// figure and with a next step.
void expect(const app::Finding& found,
            app::Severity severity,
            const std::string& kind,
            const std::string& where,
            const std::string& figure);

}  // namespace marey::testing
