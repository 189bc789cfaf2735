// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: soft-tissue artefact. Tags deviate from where a rigid body
// would carry them: skin moves on bones, and a neck is more than one bone. The size of
// the deviation (slip) is unknown beforehand. It is estimated from the residuals of the
// tags at the best solution.

#include <array>
#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "reconstruct/tags/body_model.h"

namespace marey::reconstruct {

/// Standard deviation of a tag's place about the model's, per coordinate. [m]
using SlipSigmas = std::array<double, kHumanBoneCount>;

/// The slip of one sighting. Its eight residuals, in sigmas of their corners, are the sum
/// of the corners' errors and these directions times the tag's slip.
struct TagSlip {
  /// Orthonormal columns: common movement of the residuals when the whole tag slips.
  Eigen::Matrix<double, 8, 3> directions = Eigen::Matrix<double, 8, 3>::Zero();
  /// Residual in sigmas per metre of slip, along each direction. [1/m]
  Eigen::Vector3d gains = Eigen::Vector3d::Zero();
  double sigma_m = 0.0;
  /// Number of cameras seeing this tag. Their errors share one slip, so the slip variance
  /// is scaled by this number.
  double cameras = 1.0;

  /// Factor by which the residual along each direction is larger than its corners'
  /// errors.
  [[nodiscard]] Eigen::Array3d stretch() const {
    return (1.0 + cameras * (sigma_m * gains.array()).square()).sqrt();
  }
  /// Share of its square that the slip of the tag explains.
  [[nodiscard]] Eigen::Array3d explained() const {
    return (1.0 + (sigma_m * gains.array()).square()) / stretch().square();
  }
};

/// Computes the slip at this posture. A tag behind the camera has none.
[[nodiscard]] TagSlip tag_slip(const BodyModel& model,
                               const TagSighting& sighting,
                               std::span<const Camera> cameras,
                               const Posture& posture,
                               double sigma_m,
                               double cameras_that_see_it);

/// Estimates the slip of each segment from residuals: restricted maximum likelihood, by
/// scoring. Add every sighting of a trial, then call improved().
class SlipEstimate {
 public:
  /// Adds a sighting. `residuals` are in sigmas, slip included; `jacobian` is their
  /// derivative by the posture; `covariance` is that of the posture solved from them.
  void add(HumanBone bone,
           const TagSlip& slip,
           const Eigen::Matrix<double, 8, 1>& residuals,
           const Eigen::Matrix<double, 8, Eigen::Dynamic>& jacobian,
           const Eigen::MatrixXd& covariance);

  /// Returns the next estimate, given the sigmas with which the residuals were computed.
  /// A segment whose tags give little information on its slip gets the slip of the other
  /// segments.
  [[nodiscard]] SlipSigmas improved(const SlipSigmas& sigmas_m) const;

  /// Returns the ratio of the residuals to their expected size: 1 if the sigmas are
  /// right. At least 1.
  [[nodiscard]] double scale() const;

 private:
  struct Sums {
    double excess = 0.0;       ///< Score: squared slips minus their expectation.
    double information = 0.0;  ///< Information on the squared sigma.
    int count = 0;
  };
  std::array<Sums, kHumanBoneCount> sums_{};
  double squares_ = 0.0;
  double freedom_ = 0.0;
};

}  // namespace marey::reconstruct
