// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: one posture's normal equations, in fixed storage.

#include <array>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "reconstruct/posture/pose_parameter_priors.h"
#include "reconstruct/posture/posture_derivatives.h"

namespace marey::reconstruct {

/// Expected pose parameters from sources other than this frame's markers.
struct PosturePrior {
  Posture expected;
  /// Inverse covariance of each parameter's unknowns, as in move_bones(); for scalars the
  /// first entry.
  std::array<Eigen::Matrix3d, kPoseParameterCount> information{};
};

/// Gauss-Newton's equations of a posture: half the squared residuals, their gradient and
/// the lower triangle of the approximate Hessian.
struct PostureEquations {
  PostureMatrix hessian;
  PostureVector gradient;
  double cost = 0.0;

  void clear();
  /// Adds three residuals with one derivative. Does not add their cost.
  void add(const SparseDerivative& derivative,
           const Eigen::Vector3d& residual,
           double weight);
  /// Adds the priors of human postures (pose_parameter_priors.h). Some 3 microseconds.
  /// Priors of usual behaviour, unlike anatomical ones, have `share` of their weight:
  /// consecutive frames repeat the same information. `collar_bone_factor` multiplies the
  /// sigmas of the collar bones' rotation about their vertical and forward axes.
  void add_posture_priors(const Posture& posture,
                          const UnfoldedPosture& unfolded,
                          const TwistPriors& twists,
                          double share = 1.0,
                          double collar_bone_factor = 1.0);
  /// Adds the prior of a person standing still and upright, feet flat, hands in line with
  /// the forearms with `share` of its weight.
  void add_standing(const Posture& posture,
                    const UnfoldedPosture& unfolded,
                    double share = 1.0);
  void add_prior(const Posture& posture,
                 const Lengths& lengths,
                 const PosturePrior& prior);

 private:
  void add_rotation(const Eigen::Vector3d& residual,
                    const Eigen::Vector3d& sigma_rad,
                    double share,
                    SparseDerivative& turn);
  void add_scalar(int column, double off, double sigma);
  void add_halfway(const Posture& posture, const SpineBendPrior& row, double share);
  void add_relative(const Posture& posture,
                    const RelativePosePrior& row,
                    const glm::dvec3& sigma_rad,
                    double share);
  void add_extremity(const Posture& posture,
                     const UnfoldedPosture& unfolded,
                     std::size_t limb,
                     double sigma_rad,
                     double share);
  void add_upright(const Posture& posture,
                   PoseParameter parameter,
                   double sigma_rad,
                   bool roll);
};

/// Covariance of a posture's unknowns, without the blocks between two limbs: not filled.
struct PostureCovariance {
  PostureMatrix full;
  [[nodiscard]] Eigen::Matrix3d of(const SparseDerivative& d) const;
};

/// Cholesky factors of the equations: limbs first, then the trunk. No allocation.
class ArrowFactor {
 public:
  /// Factors the equations. False if they are not positive definite. `damping` is added
  /// to the diagonal, in shares of it. Some 10 microseconds.
  [[nodiscard]] bool factor(const PostureMatrix& hessian, double damping);
  /// Computes the step down the gradient.
  void step(const PostureVector& gradient, PostureVector& out) const;
  void covariance(PostureCovariance& out) const;

 private:
  using LimbMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 12, 12>;
  using LimbByTrunk = Eigen::Matrix<double, Eigen::Dynamic, kTrunkFreedom, 0, 12, 18>;
  struct Limb {
    Eigen::LLT<LimbMatrix> own;
    LimbByTrunk by_trunk;  ///< The limb's equations solved for the trunk's columns.
  };
  std::array<Limb, 4> limbs_;
  Eigen::LLT<Eigen::Matrix<double, kTrunkFreedom, kTrunkFreedom>> trunk_;
};

}  // namespace marey::reconstruct
