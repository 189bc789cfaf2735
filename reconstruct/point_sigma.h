// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: one number for how well a point is known, and what it means.

#include <Eigen/Core>

#include "core/humanoid.h"
#include "core/provenance.h"

namespace marey::reconstruct {

/// Returns the standard deviation per coordinate of the error that is alike in all
/// directions and within whose 95 % ball 95 % of the errors of this covariance are: the
/// root mean square over coordinates where they are alike, up to 1.21 times that where
/// one direction is much less known than the others, as a knee along its hinge.
/// The sum of squares has a chi-square distribution with Satterthwaite's (1946) degrees
/// of freedom; its quantile is Wilson & Hilferty's (1931). [m]
/// Precondition: positive semidefinite but for rounding.
[[nodiscard]] double point_sigma_m(const Eigen::Matrix3d& covariance);

/// Returns what a joint's place comes from, when `seen` is what is known of its segment:
/// limbs' joints that are known to no better than 20 mm are inferred (core/provenance.h),
/// as 95 % of their errors reach 56 mm.
[[nodiscard]] Source source_of_joint(HumanBone joint, Source seen, double sigma_m);

}  // namespace marey::reconstruct
