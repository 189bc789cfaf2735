// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/point_sigma.h"

#include <algorithm>
#include <cmath>

namespace marey::reconstruct {
namespace {

/// 95 % quantile of chi-square over its degrees of freedom.
double quantile95_per_freedom(double freedom) {
  constexpr double kNormal95 = 1.6448536269514722;
  const double spread = 2.0 / (9.0 * freedom);
  const double root = 1.0 - spread + kNormal95 * std::sqrt(spread);
  return root * root * root;
}

}  // namespace

double point_sigma_m(const Eigen::Matrix3d& covariance) {
  const double mean = covariance.trace();
  const double squares = covariance.squaredNorm();  // Of the eigenvalues.
  if (!(mean > 0.0) || !(squares > 0.0)) return 0.0;
  const double freedom = mean * mean / squares;
  return std::sqrt(mean / 3.0 * quantile95_per_freedom(freedom) /
                   quantile95_per_freedom(3.0));
}

Source source_of_joint(HumanBone joint, Source seen, double sigma_m) {
  constexpr double kKnown_m = 0.02;
  const bool is_of_limb = std::ranges::any_of(human_limbs(), [&](const HumanLimb& limb) {
    return joint == limb.upper || joint == limb.lower || joint == limb.end;
  });
  return is_of_limb && sigma_m > kKnown_m ? Source::kInferred : seen;
}

}  // namespace marey::reconstruct
