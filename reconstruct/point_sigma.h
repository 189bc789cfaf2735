// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: one number for how well a point is known, and what it means.

#include <Eigen/Core>

#include "core/humanoid.h"
#include "core/provenance.h"

namespace marey::reconstruct {

/// Returns the sigma per coordinate of the isotropic error whose 95 % ball has the same
/// radius as that of this covariance: the root mean square over coordinates where all
/// directions are alike, up to 1.20 times that where one is much less known than the
/// others, as for a knee along its hinge.
/// The sum of squares has a chi-square distribution with Satterthwaite's (1946) degrees
/// of freedom; its quantile is Wilson & Hilferty's (1931). [m]
/// Preconditions: finite, positive semidefinite but for rounding.
[[nodiscard]] double point_sigma_m(const Eigen::Matrix3d& covariance);

/// Returns the source of a joint: that of its segment, or kInferred for a limb's joint
/// with a sigma above kMostMeasuredSigma_m (core/provenance.h).
[[nodiscard]] Source source_of_joint(HumanBone joint,
                                     Source segment_source,
                                     double sigma_m);

}  // namespace marey::reconstruct
