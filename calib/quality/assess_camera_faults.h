// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Checks for a camera that was moved during the recording, and for a rolling shutter
/// that was not solved for.
void assess_camera_faults(FindingList& list);

/// Returns true if assess_camera_faults() reports this camera as moved.
[[nodiscard]] bool seems_moved(const CalibrationReport& report, std::size_t c);

}  // namespace marey::calib
