// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture_equations.h"

#include <cmath>
#include <optional>

#include "core/base/cross_matrix.h"

namespace marey::reconstruct {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::optional<std::size_t> limb_of_frame(PoseParameter parameter) {
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    if (kLimbParameters[limb].frame == parameter) return limb;
  }
  return std::nullopt;
}

Quaterniond from_vector(const glm::dvec3& v) {
  const glm::dquat q = rotation_from_vector(v);
  return {q.w, q.x, q.y, q.z};
}

}  // namespace

void PostureEquations::clear() {
  hessian.setZero();
  gradient.setZero();
  cost = 0.0;
}

void PostureEquations::add(const SparseDerivative& d,
                           const Vector3d& residual,
                           double weight) {
  for (int i = 0; i < d.columns; ++i) {
    const int row = d.column[static_cast<std::size_t>(i)];
    const Vector3d weighted = weight * d.value.col(i);
    gradient[row] += weighted.dot(residual);
    for (int j = 0; j <= i; ++j) {
      const int column = d.column[static_cast<std::size_t>(j)];
      const double product = weighted.dot(d.value.col(j));
      // Columns are not in ascending order; the lower triangle holds both halves.
      if (row >= column) {
        hessian(row, column) += product;
      } else {
        hessian(column, row) += product;
      }
    }
  }
}

void PostureEquations::add_scalar(int column, double off, double sigma) {
  const double weight = 1.0 / (sigma * sigma);
  hessian(column, column) += weight;
  gradient[column] += weight * off;
  cost += 0.5 * weight * off * off;
}

/// Adds `residual` in the frame of `sigma_rad`; `turn` is its derivative there.
void PostureEquations::add_rotation(const Vector3d& residual,
                                    const Vector3d& sigma_rad,
                                    double share,
                                    SparseDerivative& turn) {
  const Vector3d scale = sigma_rad.cwiseInverse();
  const Matrix3d jacobian =
      scale.asDiagonal() * inverse_left_jacobian(residual).transpose();
  for (int i = 0; i < turn.columns; ++i) {
    turn.value.col(i) = jacobian * turn.value.col(i);
  }
  const Vector3d scaled = scale.cwiseProduct(residual);
  add(turn, scaled, share);
  cost += 0.5 * share * scaled.squaredNorm();
}

// A residual log(E^-1 C) of a part C and its expectation E, both rotating in the world,
// changes by the inverse right Jacobian times C^T (dC - dE); the right one is the
// transpose of the left one.

void PostureEquations::add_halfway(const Posture& posture,
                                   const SpineBendPrior& row,
                                   double share) {
  const Quaterniond lower = quaternion(posture, row.lower);
  const Quaterniond middle = quaternion(posture, row.middle);
  const Quaterniond upper = quaternion(posture, row.upper);
  const Vector3d off = log_of(detail::halfway<double>(lower, upper).conjugate() * middle);
  const HalfwayDerivative half = halfway_derivative(lower, upper);
  const Matrix3d to_own = middle.toRotationMatrix().transpose();
  SparseDerivative turn;
  turn.add(column_of(row.middle), to_own);
  turn.add(column_of(row.lower), Matrix3d(-to_own * half.by_lower));
  turn.add(column_of(row.upper), Matrix3d(-to_own * half.by_upper));
  add_rotation(off, Vector3d::Constant(row.sigma_rad), share, turn);
}

void PostureEquations::add_relative(const Posture& posture,
                                    const RelativePosePrior& row,
                                    const glm::dvec3& sigma_rad,
                                    double share) {
  const Quaterniond child = quaternion(posture, row.child);
  const Quaterniond expected =
      quaternion(posture, row.parent) * from_vector(row.usual_rad);
  const Matrix3d to_own = child.toRotationMatrix().transpose();
  SparseDerivative turn;
  turn.add(column_of(row.child), to_own);
  turn.add(column_of(row.parent), Matrix3d(-to_own));
  add_rotation(log_of(expected.conjugate() * child),
               {sigma_rad.x, sigma_rad.y, sigma_rad.z},
               share,
               turn);
}

void PostureEquations::add_extremity(const Posture& posture,
                                     const UnfoldedPosture& unfolded,
                                     std::size_t limb,
                                     double sigma_rad,
                                     double share) {
  const LimbParameters& s = kLimbParameters[limb];
  const Quaterniond end = quaternion(posture, s.extremity);
  const Matrix3d to_own = end.toRotationMatrix().transpose();
  const Quaterniond lower(unfolded.rotation(human_limbs()[limb].lower));
  SparseDerivative turn;
  unfolded.turn_derivative(human_limbs()[limb].lower, turn);
  for (int i = 0; i < turn.columns; ++i) turn.value.col(i) = -to_own * turn.value.col(i);
  turn.add(column_of(s.extremity), to_own);
  add_rotation(
      log_of(lower.conjugate() * end), Vector3d::Constant(sigma_rad), share, turn);
}

void PostureEquations::add_posture_priors(const Posture& posture,
                                          const UnfoldedPosture& unfolded,
                                          const TwistPriors& twists,
                                          double share,
                                          double collar_bone_factor) {
  for (const SpineBendPrior& row : kSpineBendPriors) add_halfway(posture, row, 1.0);
  for (const RelativePosePrior& row : kRelativePosePriors) {
    glm::dvec3 sigma_rad = row.sigma_rad;
    if (row.child == PoseParameter::kLeftShoulder ||
        row.child == PoseParameter::kRightShoulder) {
      sigma_rad *= glm::dvec3(1.0, collar_bone_factor, collar_bone_factor);
    }
    add_relative(posture, row, sigma_rad, row.anatomy ? 1.0 : share);
  }
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    const LimbParameters& s = kLimbParameters[limb];
    const bool arm = limb < 2;
    add_extremity(posture, unfolded, limb, extremity_sigma_rad(limb), share);
    const double flexion = *posture.block(s.flexion);
    const int column = column_of(s.flexion);
    // A share of the weight is the inverse root of the share in the sigma.
    const double wider = 1.0 / std::sqrt(share);
    add_scalar(column, flexion - kUsualFlexion_rad, wider * kFlexionSigma_rad);
    // Limits hold in every frame.
    if (flexion < kMinFlexion_rad) {
      add_scalar(column, flexion - kMinFlexion_rad, kMinFlexionSigma_rad);
    }
    add_scalar(column_of(s.upper_twist),
               *posture.block(s.upper_twist),
               arm ? twists.upper_arm : twists.leg);
    add_scalar(column_of(s.lower_twist),
               *posture.block(s.lower_twist),
               arm ? wider * twists.forearm : twists.leg);
  }
}

void PostureEquations::add_upright(const Posture& posture,
                                   PoseParameter parameter,
                                   double sigma_rad,
                                   bool roll) {
  const Matrix3d to_own = quaternion(posture, parameter).toRotationMatrix().transpose();
  const Vector3d up = to_own.col(1);
  const Matrix3d by_turn = to_own * cross_matrix<Matrix3d>(Vector3d::UnitY());
  const double weight = 1.0 / (sigma_rad * sigma_rad);
  const int column = column_of(parameter);
  const auto level = [&](int axis) {
    const Vector3d row = by_turn.row(axis).transpose();
    hessian.block<3, 3>(column, column) += weight * row * row.transpose();
    gradient.segment<3>(column) += weight * up[axis] * row;
    cost += 0.5 * weight * up[axis] * up[axis];
  };
  level(2);
  if (roll) level(0);
}

void PostureEquations::add_standing(const Posture& posture,
                                    const UnfoldedPosture& unfolded,
                                    double share) {
  // A share of the weight is the inverse root of the share in the sigma.
  const double wider = 1.0 / std::sqrt(share);
  // The hips' roll is measured: their X axis runs through both hip centres.
  add_upright(posture, PoseParameter::kHips, kStandingTrunkSigma_rad * wider, false);
  add_upright(posture, PoseParameter::kThorax, kStandingTrunkSigma_rad * wider, true);
  add_upright(posture, PoseParameter::kHead, kStandingTrunkSigma_rad * wider, true);
  add_upright(posture, PoseParameter::kLeftFoot, kStandingFootSigma_rad * wider, true);
  add_upright(posture, PoseParameter::kRightFoot, kStandingFootSigma_rad * wider, true);
  add_halfway(posture,
              {PoseParameter::kHips,
               PoseParameter::kAbdomenEnd,
               PoseParameter::kThorax,
               kStandingBendSigma_rad},
              share);
  const glm::dvec3 near(kStandingTurnSigma_rad);
  for (const PoseParameter child : {PoseParameter::kHead,
                                    PoseParameter::kLeftShoulder,
                                    PoseParameter::kRightShoulder}) {
    add_relative(posture, {PoseParameter::kThorax, child, {0, 0, 0}, near}, near, share);
  }
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    const LimbParameters& s = kLimbParameters[limb];
    add_extremity(posture,
                  unfolded,
                  limb,
                  limb < 2 ? kStandingHandSigma_rad : kStandingAnkleSigma_rad,
                  share);
    add_scalar(column_of(s.upper_twist),
               *posture.block(s.upper_twist),
               kStandingTwistSigma_rad * wider);
    add_scalar(column_of(s.lower_twist),
               *posture.block(s.lower_twist),
               kStandingTwistSigma_rad * wider);
  }
}

void PostureEquations::add_prior(const Posture& posture,
                                 const Lengths& lengths,
                                 const PosturePrior& prior) {
  const PostureVector off = bone_step_between(prior.expected, posture, lengths);
  for (const PoseParameter parameter : kAllPoseParameters) {
    const Matrix3d& information = prior.information[index(parameter)];
    const int column = column_of(parameter);
    if (tangent_size(parameter) == 1) {
      hessian(column, column) += information(0, 0);
      gradient[column] += information(0, 0) * off[column];
      cost += 0.5 * information(0, 0) * off[column] * off[column];
      continue;
    }
    const Vector3d own = off.segment<3>(column);
    const Matrix3d jacobian = is_rotation(parameter) ? inverse_left_jacobian(own)
                                                     : Matrix3d(Matrix3d::Identity());
    const Matrix3d weighted = information * jacobian;
    const Matrix3d normal = jacobian.transpose() * weighted;
    const Vector3d pull = weighted.transpose() * own;
    hessian.block<3, 3>(column, column) += normal;
    gradient.segment<3>(column) += pull;
    cost += 0.5 * own.dot(information * own);
    if (const auto limb = limb_of_frame(parameter)) {
      // The upper bone also turns with the limb's flexion.
      const Vector3d by_flexion = upper_by_flexion(posture, *limb, lengths);
      const int flexion = column_of(kLimbParameters[*limb].flexion);
      const Vector3d across = normal * by_flexion;
      // Columns of flexions come after those of their frames: the lower triangle.
      hessian.block<1, 3>(flexion, column) += across.transpose();
      hessian(flexion, flexion) += by_flexion.dot(across);
      gradient[flexion] += by_flexion.dot(pull);
    }
  }
}

Matrix3d PostureCovariance::of(const SparseDerivative& d) const {
  Matrix3d sum = Matrix3d::Zero();
  for (int i = 0; i < d.columns; ++i) {
    Vector3d row = Vector3d::Zero();
    for (int j = 0; j < d.columns; ++j) {
      row += full(d.column[static_cast<std::size_t>(i)],
                  d.column[static_cast<std::size_t>(j)]) *
             d.value.col(j);
    }
    sum.noalias() += d.value.col(i) * row.transpose();
  }
  return sum;
}

bool ArrowFactor::factor(const PostureMatrix& hessian, double damping) {
  Eigen::Matrix<double, kTrunkFreedom, kTrunkFreedom> trunk =
      hessian.block<kTrunkFreedom, kTrunkFreedom>(kTrunkColumn, kTrunkColumn);
  trunk.diagonal() *= 1.0 + damping;
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const int size = kLimbFreedom[limb];
    const int at = kLimbColumn[limb];
    LimbMatrix own = hessian.block(at, at, size, size);
    own.diagonal() *= 1.0 + damping;
    limbs_[limb].own.compute(own);
    if (limbs_[limb].own.info() != Eigen::Success) return false;
    // The trunk's columns come last: in the lower triangle they are the rows below.
    const LimbByTrunk cross =
        hessian.block(kTrunkColumn, at, kTrunkFreedom, size).transpose();
    limbs_[limb].by_trunk = limbs_[limb].own.solve(cross);
    trunk.noalias() -= cross.transpose().lazyProduct(limbs_[limb].by_trunk);
  }
  trunk_.compute(trunk);
  return trunk_.info() == Eigen::Success;
}

void ArrowFactor::step(const PostureVector& gradient, PostureVector& out) const {
  Eigen::Matrix<double, kTrunkFreedom, 1> trunk =
      -gradient.segment<kTrunkFreedom>(kTrunkColumn);
  for (std::size_t limb = 0; limb < 4; ++limb) {
    trunk.noalias() += limbs_[limb].by_trunk.transpose().lazyProduct(
        gradient.segment(kLimbColumn[limb], kLimbFreedom[limb]));
  }
  trunk_.solveInPlace(trunk);
  out.segment<kTrunkFreedom>(kTrunkColumn) = trunk;
  for (std::size_t limb = 0; limb < 4; ++limb) {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 12, 1> own =
        -gradient.segment(kLimbColumn[limb], kLimbFreedom[limb]);
    limbs_[limb].own.solveInPlace(own);
    own.noalias() -= limbs_[limb].by_trunk.lazyProduct(trunk);
    out.segment(kLimbColumn[limb], kLimbFreedom[limb]) = own;
  }
}

void ArrowFactor::covariance(PostureCovariance& out) const {
  using Trunk = Eigen::Matrix<double, kTrunkFreedom, kTrunkFreedom>;
  const Trunk trunk = trunk_.solve(Trunk::Identity());
  out.full.setZero();
  out.full.block<kTrunkFreedom, kTrunkFreedom>(kTrunkColumn, kTrunkColumn) = trunk;
  for (std::size_t limb = 0; limb < 4; ++limb) {
    const int size = kLimbFreedom[limb];
    const int at = kLimbColumn[limb];
    const LimbByTrunk cross = -limbs_[limb].by_trunk.lazyProduct(trunk);
    const LimbMatrix own = limbs_[limb].own.solve(LimbMatrix::Identity(size, size)) -
                           cross.lazyProduct(limbs_[limb].by_trunk.transpose()).eval();
    out.full.block(at, at, size, size) = own;
    out.full.block(at, kTrunkColumn, size, kTrunkFreedom) = cross;
    out.full.block(kTrunkColumn, at, kTrunkFreedom, size) = cross.transpose();
  }
}

}  // namespace marey::reconstruct
