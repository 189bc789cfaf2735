// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Appends findings about residuals, outliers, lags, the lens model and the floor. Limits
/// are in calibration_limits.h, in pixels of an image up to 1920 px wide.
void assess_residuals(FindingList& list);

/// Returns true if the errors of camera `c` significantly follow the motion of the
/// target: its clock is ahead of or behind the others by more than six sigmas.
[[nodiscard]] bool has_clock_offset(const CalibrationReport& report, std::size_t c);

}  // namespace marey::calib
