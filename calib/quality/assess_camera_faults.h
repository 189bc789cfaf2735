// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_collector.h"

namespace marey::calib {

/// Appends findings about faults of single cameras, in this order:
/// - moved: the views from a frame on fit a pose that is moved by more than 0.6 px (poor
///   above 1 px, or if cameras shift by more than the limit for usable errors);
/// - unsteady: a smaller move, or a change of focus, that shifts the calibrated cameras
/// by
///   more than the limit for good errors (poor: for usable errors);
/// - rolling-shutter: line delays that were not solved for, of more than 4 ms per image
///   and 8 sigmas (poor if cameras shift by more than the limit for good errors);
/// - ambiguous: the views fit two poses of a camera (poor).
/// A move and line delays have similar effects: only the one with the larger gain is
/// reported, from a gain of 400 (squared sigmas). The limits of errors are
/// CalibrationLimits::error_m. Reads the results of apparent_faults.h in `report.rig`.
void assess_camera_faults(FindingCollector& list);

/// Returns true if assess_camera_faults() reports camera `c` as moved. Other checks do
/// not report it again.
[[nodiscard]] bool seems_moved(const CalibrationReport& report, std::size_t c);

}  // namespace marey::calib
