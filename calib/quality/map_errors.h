// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/calibration_report.h"

namespace marey::calib {

/// Returns the expected errors of points in the volume. With a floor, the map covers a
/// square of 4 m around the point at which the cameras look, and the positions of the
/// board; its heights are those of ankle, hip and shoulder. Without a floor, it covers
/// the positions of the board, at the 10 %, 50 % and 90 % quantiles of their heights.
[[nodiscard]] CalibrationMap map_errors(const CalibrationReport& report);

}  // namespace marey::calib
