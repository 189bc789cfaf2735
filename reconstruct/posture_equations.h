// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: one posture's normal equations, in fixed storage.

#include <array>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "reconstruct/posture_derivatives.h"
#include "reconstruct/posture_habits.h"

namespace marey::reconstruct {

/// What a slot is expected to be, by what is known beside this frame's markers.
struct PosturePrior {
  Posture expected;
  /// Inverse covariance of each slot's unknowns, as in move_bones(); of scalars the first
  /// entry.
  std::array<Eigen::Matrix3d, kSlotCount> information{};
};

/// Gauss-Newton's equations of a posture: half the squared residuals, their gradient and
/// the approximate Hessian, of which the lower triangle is kept.
struct PostureEquations {
  PostureMatrix hessian;
  PostureVector gradient;
  double cost = 0.0;

  void clear();
  /// Three residuals with one derivative; the cost is the caller's.
  void add(const SparseDerivative& derivative,
           const Eigen::Vector3d& residual,
           double weight);
  /// Habits of human bodies (posture_habits.h). Some 3 microseconds.
  /// What people do, unlike how they are built, counts with `share` of its weight: of
  /// frames that follow each other it says the same again. Collar bones may be
  /// `shoulders_wider` times as far as usual from lying level and sideways.
  void add_habits(const Posture& posture,
                  const UnfoldedPosture& unfolded,
                  const TwistHabits& twists,
                  double share = 1.0,
                  double shoulders_wider = 1.0);
  /// A person standing still and upright, feet flat, hands in line with the forearms
  /// (add_standing() of posture_terms.h), with `share` of its weight.
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
  void add_halfway(const Posture& posture, const HalfwayHabit& row, double share);
  void add_relative(const Posture& posture,
                    const RelativeHabit& row,
                    const glm::dvec3& sigma_rad,
                    double share);
  void add_extremity(const Posture& posture,
                     const UnfoldedPosture& unfolded,
                     std::size_t limb,
                     double sigma_rad,
                     double share);
  void add_upright(const Posture& posture, Slot slot, double sigma_rad, bool roll);
};

/// Covariance of a posture's unknowns, but for what two limbs share: left empty.
struct PostureCovariance {
  PostureMatrix full;
  [[nodiscard]] Eigen::Matrix3d of(const SparseDerivative& d) const;
};

/// Cholesky's factors of the equations: limbs first, then the trunk. No allocation.
class ArrowFactor {
 public:
  /// False where the equations are not positive definite. `damping` is added to the
  /// diagonal, in shares of it. Some 10 microseconds.
  [[nodiscard]] bool factor(const PostureMatrix& hessian, double damping);
  /// The step down the gradient.
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
