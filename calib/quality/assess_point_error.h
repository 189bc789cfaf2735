// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Checks the expected error of 3D points and the hold-out validation of frames and
/// cameras.
void assess_point_error(FindingList& list);

}  // namespace marey::calib
