// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "calib/quality/calibration_report.h"

namespace marey::app {

/// Returns the content of calibration.json (docs/formats/calibration.md).
[[nodiscard]] nlohmann::ordered_json calibration_json(
    const calib::CalibrationReport& report);

/// Returns calibration_json() as text.
[[nodiscard]] std::string calibration_json_text(const calib::CalibrationReport& report);

}  // namespace marey::app
