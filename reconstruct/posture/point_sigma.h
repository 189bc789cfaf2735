// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the sigma of a point, as one number, from its covariance.

#include <Eigen/Core>

#include "core/humanoid.h"
#include "core/source.h"

namespace marey::reconstruct {

/// Returns the sigma per coordinate of the isotropic error whose 95 % ball has the same
/// radius as that of this covariance: the root mean square over coordinates if all
/// directions are alike, up to 1.20 times that if one has a much larger variance than the
/// others, as for a knee along its hinge. The sum of squares has a chi-square
/// distribution with Satterthwaite's (1946) degrees of freedom; its quantile is Wilson &
/// Hilferty's (1931). [m]
/// Preconditions: finite, positive semidefinite except for rounding.
[[nodiscard]] double point_sigma_m(const Eigen::Matrix3d& covariance);

/// Returns the source of a joint: that of its segment, or kInferred for a limb's joint
/// with a sigma above kMaxMeasuredSigma_m (measured_sigma.h).
[[nodiscard]] Source source_of_joint(HumanBone joint,
                                     Source segment_source,
                                     double sigma_m);

}  // namespace marey::reconstruct
