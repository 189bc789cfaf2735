// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/finding_list.h"

namespace marey::app {

/// What is left of what they saw: residuals, outliers, lags, lens, floor.
void judge_residuals(FindingList& list);

/// Whether the errors of camera `c` clearly follow the movement of what it was shown.
[[nodiscard]] bool is_late(const CalibrationReport& report, std::size_t c);

}  // namespace marey::app
