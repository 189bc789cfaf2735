// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_list.h"

namespace marey::calib {

/// Appends findings about single cameras: one that was moved during the recording
/// ("moved"), one whose focus or mount changed so little that it hardly shows in its
/// image
/// ("unsteady"), one whose place is ambiguous ("ambiguous"), and a rolling shutter that
/// was not solved for ("rolling-shutter"). Limits are in the source and in
/// calibration_limits.h. Precondition: the report's measures are complete.
void assess_camera_faults(FindingList& list);

/// Returns true if assess_camera_faults() reports this camera as moved.
[[nodiscard]] bool seems_moved(const CalibrationReport& report, std::size_t c);

}  // namespace marey::calib
