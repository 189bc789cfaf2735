// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Checks that clock offsets, drifts and line delays are plausible and constant over the
/// recording.
void assess_timing(FindingList& list);

}  // namespace marey::calib
