// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/calibration_limits.h"

#include <algorithm>

namespace marey::app {

CalibrationLimits limits_of(const CalibrationReport& report) {
  // A joint is known to some 10 mm at best (skin moves over it): cameras that err by less
  // hardly show, and beyond twice that nothing else matters. That is for a person, three
  // metres away; what is smaller and nearer is looked at more closely, and the other way
  // round.
  constexpr double kFair_m = 0.008;
  constexpr double kPoor_m = 0.020;
  constexpr double kUsualDistance_m = 3.0;
  const double scale = std::max(0.1, report.map.distance_m / kUsualDistance_m);
  return {{kFair_m * scale, kPoor_m * scale},
          kResidualLimitsPx,
          kCoverageLimits,
          kFairShared};
}

}  // namespace marey::app
