// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/quality/finding_collector.h"

namespace marey::calib {

/// Appends findings about the expected error of 3D points and the hold-out validation.
/// Expected error (limits: CalibrationLimits::error_m): in the middle of the volume; in
/// more than a fifth of the area around it; the middle or the area seen by fewer than two
/// cameras. Hold-out, if the report has a cross validation: the residual of unused frames
/// (above 0.3 px and 1.5 times that of used ones), of each camera computed from the
/// others (above 2 px and 3 times the median), and the distance of a camera's two
/// positions from even and odd frames, and from the first and the second half of the
/// recording (above twice the expected distance). Preconditions: as assess_calibration();
/// the report's map is computed.
void assess_point_error(FindingCollector& list);

}  // namespace marey::calib
