// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/point_sigma.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "reconstruct/posture/measured_sigma.h"

namespace marey::reconstruct {
namespace {

/// Returns the 95 % quantile of chi-square over its degrees of freedom.
double quantile95_per_freedom(double freedom) {
  constexpr double kNormal95 = 1.6448536269514722;
  const double spread = 2.0 / (9.0 * freedom);
  const double root = 1.0 - spread + kNormal95 * std::sqrt(spread);
  return root * root * root;
}

}  // namespace

double point_sigma_m(const Eigen::Matrix3d& covariance) {
  MAREY_ASSERT(covariance.allFinite());
  const double trace = covariance.trace();
  const double squares = covariance.squaredNorm();  // Sum of squared eigenvalues.
  if (trace <= 0.0 || squares <= 0.0) return 0.0;
  const double freedom = trace * trace / squares;
  return std::sqrt(trace / 3.0 * quantile95_per_freedom(freedom) /
                   quantile95_per_freedom(3.0));
}

Source source_of_joint(HumanBone joint, Source segment_source, double sigma_m) {
  const bool is_of_limb = std::ranges::any_of(human_limbs(), [&](const HumanLimb& limb) {
    return joint == limb.upper || joint == limb.lower || joint == limb.end;
  });
  return is_of_limb && sigma_m > kMaxMeasuredSigma_m ? Source::kInferred : segment_source;
}

}  // namespace marey::reconstruct
