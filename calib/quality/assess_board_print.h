// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_collector.h"

namespace marey::calib {

/// Appends a finding if the printed AprilGrid does not have its declared sizes: the
/// median over cameras of the squares' shrinkage relative to the gaps is above 0.8 %
/// (fair) or 1.5 % (poor). A wrong size changes this ratio by the same share in all
/// cameras. Lens blur and light change it in one camera by a number of pixels. No finding
/// for other targets, whose shrinkage is 0. Reads TagShrinkage::slope of the cameras.
void assess_board_print(FindingCollector& list);

}  // namespace marey::calib
