// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/quality/calibration_report.h"

namespace marey::calib {

/// Returns the measures of each camera. `report` has its rig, extent and clocks.
[[nodiscard]] std::vector<CameraMeasures> measure_cameras(
    const CalibrationReport& report);

}  // namespace marey::calib
