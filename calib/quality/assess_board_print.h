// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Appends a finding if the printed AprilGrid has not its declared sizes. A wrong size
/// changes the ratio of black squares to gaps by the same share in all cameras. Lens blur
/// and light change it in one camera by a number of pixels.
void assess_board_print(FindingList& list);

}  // namespace marey::calib
