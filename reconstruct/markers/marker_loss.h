// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Robust loss of a marker in the fit of postures and of the subject.

#include <cmath>

// Private to reconstruct.
namespace marey::reconstruct {

/// Scale of the Cauchy loss, in sigmas of a marker.
inline constexpr double kMarkerLossSigmas = 3.0;
inline constexpr double kMarkerLossSigmas2 = kMarkerLossSigmas * kMarkerLossSigmas;

/// Returns half the robust square of a marker's three residuals.
[[nodiscard]] inline double marker_cost(double squared) {
  return 0.5 * kMarkerLossSigmas2 * std::log1p(squared / kMarkerLossSigmas2);
}

/// Returns the weight in the normal equations of a marker with this information.
[[nodiscard]] inline double marker_weight(double information, double squared) {
  return information / (1.0 + squared / kMarkerLossSigmas2);
}

}  // namespace marey::reconstruct
