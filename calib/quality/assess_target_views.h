// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Checks the views of each camera: coverage, tilt, number, and views shared with others.
void assess_target_views(FindingList& list);

}  // namespace marey::calib
