// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Appends findings about the views of each camera: coverage of its image, tilt of the
/// board, number of views, and instants that it shares with other cameras. Limits are in
/// calibration_limits.h.
void assess_target_views(FindingList& list);

}  // namespace marey::calib
