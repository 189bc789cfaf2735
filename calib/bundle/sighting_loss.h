// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Robust losses of a sighting in the refinement of a rig.

// Private to calib.
namespace marey::calib {

/// Scale of the Cauchy loss of a tag, in sigmas of its eight residuals together, whose
/// norm is near 2.8 for inliers. The corners of a tag have correlated errors (a shadow, a
/// fold of the paper): this mild loss is used in every pass.
inline constexpr double kTagLossSigmas = 5.0;

/// Scale of the Cauchy loss of a board's point, whose norm is near 1.4 for inliers. Used
/// in the robust pass only.
inline constexpr double kPointLossSigmas = 3.0;

/// Scale of the Cauchy weight of a sighting in the test of fixed parameters, relative to
/// the typical error.
inline constexpr double kWeightScale = 3.0;

}  // namespace marey::calib
