// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Checks residuals, outliers, lags, the lens model and the floor.
void assess_residuals(FindingList& list);

/// Returns true if the errors of camera `c` follow the motion of the target by a
/// significant lag, later or earlier than the other cameras: more than 6 sigmas, and more
/// than 0.3 px (at 1920 px of image width) explained. False without a lag in the report.
/// Precondition: `c` is a camera of the report.
[[nodiscard]] bool has_significant_lag(const CalibrationReport& report, std::size_t c);

}  // namespace marey::calib
