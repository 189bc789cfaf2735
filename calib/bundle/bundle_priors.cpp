// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_priors.h"

#include <numbers>

namespace marey::calib {

bool MotionPrior::Evaluate(const double* const* blocks,
                           double* residuals,
                           double** jacobians) const {
  const auto rotation = [&](int i) {
    const double* q = blocks[i];
    return Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  };
  const auto vector = [](const Eigen::Quaterniond& q) -> Eigen::Vector3d {
    const Eigen::AngleAxisd turn(q);
    constexpr double kPi = std::numbers::pi;
    const double angle = turn.angle() > kPi ? turn.angle() - 2.0 * kPi : turn.angle();
    return angle * turn.axis();
  };
  // Rotation vectors in the world: difference of two consecutive steps.
  const Eigen::Vector3d first = vector(rotation(1) * rotation(0).conjugate());
  const Eigen::Vector3d second = vector(rotation(2) * rotation(1).conjugate());
  for (int i = 0; i < 3; ++i) {
    residuals[i] = (second[i] - first[i]) / sigma_rad_;
    residuals[3 + i] =
        (blocks[2][4 + i] - 2.0 * blocks[1][4 + i] + blocks[0][4 + i]) / sigma_m_;
  }
  if (!jacobians) return true;
  constexpr double kShare[] = {1.0, -2.0, 1.0};
  for (int b = 0; b < 3; ++b) {
    if (!jacobians[b]) continue;
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> out(jacobians[b]);
    out.setZero();
    out.topLeftCorner<3, 3>().diagonal().setConstant(kShare[b] / sigma_rad_);
    out.block<3, 3>(3, 3).diagonal().setConstant(kShare[b] / sigma_m_);
  }
  return true;
}

}  // namespace marey::calib
