// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Checks residuals, outliers, lags, the lens model and the floor.
void assess_residuals(FindingList& list);

/// Returns true if the errors of camera `c` significantly follow the motion of the
/// target.
[[nodiscard]] bool is_late(const CalibrationReport& report, std::size_t c);

}  // namespace marey::calib
