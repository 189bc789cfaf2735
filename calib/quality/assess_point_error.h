// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Appends findings about the expected error of 3D points, and about the validation by
/// frames and cameras that were held out. Limits are in calibration_limits.h.
void assess_point_error(FindingList& list);

}  // namespace marey::calib
