// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Robust loss of a tag's sighting in all fits: motion, live and subject.

#include <cmath>

// Private to reconstruct.
namespace marey::reconstruct {

/// Scale of the Cauchy loss of a tag, in sigmas of its eight residuals together, whose
/// norm is near 2.8 for inliers.
inline constexpr double kTagLossSigmas = 5.0;
inline constexpr double kTagLossSigmas2 = kTagLossSigmas * kTagLossSigmas;

/// Square of a tag behind the camera that saw it: such a posture is wrong, but the solver
/// must be able to leave it.
inline constexpr double kBehind2 = 8e6;

/// Returns half the robust square of a tag's eight residuals.
[[nodiscard]] inline double tag_cost(double squared) {
  return 0.5 * kTagLossSigmas2 * std::log1p(squared / kTagLossSigmas2);
}

/// Returns the weight of a tag in the normal equations.
[[nodiscard]] inline double tag_weight(double squared) {
  return 1.0 / (1.0 + squared / kTagLossSigmas2);
}

}  // namespace marey::reconstruct
