// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/calibration_limits.h"

#include <algorithm>

namespace marey::calib {

CalibrationLimits limits_of(const CalibrationReport& report) {
  // A joint position is accurate to about 10 mm at best (soft-tissue artefacts). Smaller
  // camera errors have little effect; above twice this value they dominate. These limits
  // are for a person three metres away; they scale with the distance.
  constexpr double kFair_m = 0.008;
  constexpr double kPoor_m = 0.020;
  constexpr double kTypicalDistance_m = 3.0;
  const double scale = std::max(0.1, report.map.distance_m / kTypicalDistance_m);
  return {{kFair_m * scale, kPoor_m * scale},
          kResidualLimitsPx,
          kCoverageLimits,
          kFairShared};
}

}  // namespace marey::calib
