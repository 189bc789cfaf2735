// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: tags are not quite where a rigid body would carry them. Skin
// moves on bones, and a neck is more than one bone. How far is not known beforehand; it
// shows in what is left of the tags when a motion explains them as well as it can.

#include <array>
#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "reconstruct/body_model.h"

namespace marey::reconstruct {

/// Standard deviation of a tag's place about the model's, per coordinate. [m]
using SlipSigmas = std::array<double, kHumanBoneCount>;

/// The slip of one sighting: its eight residuals, in sigmas of their corners, are those
/// of the corners plus these directions times what the tag slips by.
struct TagSlip {
  /// Orthonormal columns: what moves together when the tag slips as a whole.
  Eigen::Matrix<double, 8, 3> directions = Eigen::Matrix<double, 8, 3>::Zero();
  /// Residual in sigmas per metre of slip, along each. [1/m]
  Eigen::Vector3d gains = Eigen::Vector3d::Zero();
  double sigma_m = 0.0;
  /// How many cameras see this tag, and so this one slip: together they know no more of
  /// it than one, so each counts as if it slipped by more.
  double cameras = 1.0;

  /// By how much the residual along each direction is larger than its corners' errors.
  [[nodiscard]] Eigen::Array3d stretch() const {
    return (1.0 + cameras * (sigma_m * gains.array()).square()).sqrt();
  }
  /// Of this squared, what the slip of the tag does explain.
  [[nodiscard]] Eigen::Array3d explained() const {
    return (1.0 + (sigma_m * gains.array()).square()) / stretch().square();
  }
};

/// At this posture. A tag behind the camera has no slip.
[[nodiscard]] TagSlip tag_slip(const BodyModel& model,
                               const TagSighting& sighting,
                               std::span<const Camera> cameras,
                               const Posture& posture,
                               double sigma_m,
                               double cameras_that_see_it);

/// What residuals say of the slip of each segment: restricted maximum likelihood, by
/// scoring. Feed every sighting of a trial, then improve.
class SlipEstimate {
 public:
  /// `residuals` are in sigmas, slip included; `jacobian` is theirs over the posture,
  /// `covariance` the posture's that was solved from them.
  void add(HumanBone bone,
           const TagSlip& slip,
           const Eigen::Matrix<double, 8, 1>& residuals,
           const Eigen::Matrix<double, 8, Eigen::Dynamic>& jacobian,
           const Eigen::MatrixXd& covariance);

  /// The next guess for sigmas with which the residuals were made. A segment whose tags
  /// hardly contradict each other or their neighbours' is taken to slip like the others.
  [[nodiscard]] SlipSigmas improved(const SlipSigmas& sigmas_m) const;

  /// What is left, against what sigmas expect: 1 where they are right. At least 1.
  [[nodiscard]] double scale() const;

 private:
  struct Sums {
    double excess = 0.0;       ///< Score: of squared slips over what is expected.
    double information = 0.0;  ///< On the squared sigma.
    int count = 0;
  };
  std::array<Sums, kHumanBoneCount> sums_{};
  double squares_ = 0.0;
  double freedom_ = 0.0;
};

}  // namespace marey::reconstruct
