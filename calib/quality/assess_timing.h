// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Appends findings about clock offsets, drifts and line delays that are implausible, or
/// not constant over the recording.
void assess_timing(FindingList& list);

}  // namespace marey::calib
