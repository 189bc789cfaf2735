// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_collector.h"

namespace marey::calib {

/// Appends findings about residuals. For each camera: the level (good up to 0.5 px,
/// usable up to 3 px, or 2.5 times that of the others); the share of outlier corners
/// (fair above 5 %, poor above 25 %), or the frame from which it does not fit; a
/// significant lag; a systematic pattern of 0.3 px, which the lens model leaves; views of
/// the floor board or of static tags that do not fit (1.5 px and 3 times the residual).
/// For the session: single frames with half of all outliers, a floor more than 0.3 m
/// above a camera or the waved board (poor) or seen by one camera only (fair), and a bent
/// board (note, from 1 mm). Pixels as in pixel_scale().
void assess_residuals(FindingCollector& list);

/// Returns true if the errors of camera `c` follow the motion of the target by a
/// significant lag, later or earlier than the other cameras: more than 6 sigmas, and more
/// than 0.3 px (at 1920 px of image width) explained. False without a lag in the report.
/// Precondition: `c` is a camera of the report.
[[nodiscard]] bool has_significant_lag(const CalibrationReport& report, std::size_t c);

}  // namespace marey::calib
