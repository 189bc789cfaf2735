// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/point_sigma.h"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace marey::reconstruct {
namespace {

TEST(PointSigma, IsThatOfACoordinateWhereAllAreAlike) {
  EXPECT_NEAR(point_sigma_m(0.004 * 0.004 * Eigen::Matrix3d::Identity()), 0.004, 1e-12);
  EXPECT_EQ(point_sigma_m(Eigen::Matrix3d::Zero()), 0.0);
}

TEST(PointSigma, DoesNotDependOnTheAxes) {
  const Eigen::Vector3d variances(9.0, 4.0, 0.25);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_NEAR(point_sigma_m(turn * variances.asDiagonal() * turn.transpose()),
              point_sigma_m(variances.asDiagonal()),
              1e-12);
}

// Errors from random covariances, some of them flat or thin: 95 % are within the root of
// 7.81 sigmas.
TEST(PointSigma, HoldsNineteenErrorsOfTwenty) {
  std::mt19937 dice(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> decades(-2.0, 0.0);
  for (int run = 0; run < 40; ++run) {
    Eigen::Vector3d sigmas;
    for (int i = 0; i < 3; ++i) sigmas[i] = std::pow(10.0, decades(dice));
    const double sigma = point_sigma_m(sigmas.cwiseAbs2().asDiagonal().toDenseMatrix());
    constexpr int kErrors = 20000;
    int inside = 0;
    for (int i = 0; i < kErrors; ++i) {
      Eigen::Vector3d error;
      for (int k = 0; k < 3; ++k) error[k] = sigmas[k] * normal(dice);
      inside += error.squaredNorm() < 7.8147 * sigma * sigma ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(inside) / kErrors, 0.95, 0.008) << sigmas.transpose();
  }
}

TEST(SourceOfJoint, IsInferredWhereALimbsJointIsHardlyKnown) {
  using B = HumanBone;
  EXPECT_EQ(source_of_joint(B::kLeftFoot, Source::kMeasured, 0.014), Source::kMeasured);
  EXPECT_EQ(source_of_joint(B::kLeftFoot, Source::kMeasured, 0.016), Source::kInferred);
  EXPECT_EQ(source_of_joint(B::kLeftFoot, Source::kRepaired, 0.016), Source::kInferred);
  EXPECT_EQ(source_of_joint(B::kHead, Source::kMeasured, 0.05), Source::kMeasured)
      << "the trunk's joints are marey's own definitions";
}

}  // namespace
}  // namespace marey::reconstruct
