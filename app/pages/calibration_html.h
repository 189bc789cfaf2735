// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "calib/quality/calibration_report.h"

namespace marey::app {

/// Returns calibration.html: one file that loads no other.
[[nodiscard]] std::string calibration_html(const calib::CalibrationReport& report);

}  // namespace marey::app
