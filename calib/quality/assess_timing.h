// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_collector.h"

namespace marey::calib {

/// Appends findings about solved clocks that are implausible or not constant: a line
/// delay whose image takes longer than 70 ms or one frame (poor), or runs from the bottom
/// up (fair); a drift above 300 ppm (poor: 1000 ppm); both beyond 3 sigmas. A lag that
/// changes during the recording, by 0.3 px of the target's motion (poor: 1 px), unless
/// the camera is reported as moved. No finding for clocks that were not solved for (sigma
/// 0).
void assess_timing(FindingCollector& list);

}  // namespace marey::calib
