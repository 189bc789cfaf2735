// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/camera_lags.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace marey::reconstruct {
namespace {

// Webcams that start together are within a frame of each other.
constexpr double kFirstSigma_s = 0.02;
// Clocks drift by some tens of microseconds per second; groups of frames by more.
constexpr double kDriftPerRootSecond_s = 2e-4;
// Consecutive frames have correlated errors, so together they carry less information.
constexpr double kIndependentShare = 0.3;
// Bound on a camera's lag, against outliers.
constexpr double kMax_s = 0.03;

}  // namespace

CameraLags::CameraLags(const std::vector<bool>& known) : lags_s_(known.size(), 0.0) {
  for (std::size_t c = 0; c < known.size(); ++c) {
    if (!known[c] && unknown_.size() < kMax) unknown_.push_back(c);
  }
  has_reference_ = unknown_.size() < known.size();
  covariance_s2_ = kFirstSigma_s * kFirstSigma_s * spread();
}

/// Computes the covariance of lags of variance 1 that are independent of each other
/// except for their mean, which is zero unless a reference determines it.
CameraLags::Matrix CameraLags::spread() const {
  const auto count = static_cast<Eigen::Index>(unknown_.size());
  Matrix out = Matrix::Identity(count, count);
  if (!has_reference_ && count > 0) out.array() -= 1.0 / static_cast<double>(count);
  return out;
}

double CameraLags::sigma_s(std::size_t camera) const {
  const auto it = std::find(unknown_.begin(), unknown_.end(), camera);
  if (it == unknown_.end()) return 0.0;
  const auto at = static_cast<Eigen::Index>(it - unknown_.begin());
  return std::sqrt(std::max(0.0, covariance_s2_(at, at)));
}

/// Fills information_ and gradient_ from the frame's equations, its posture eliminated.
void CameraLags::measure(std::span<const TagFrameSolver::Lateness> lateness,
                         const ArrowFactor& factor) {
  const auto count = static_cast<Eigen::Index>(unknown_.size());
  information_.resize(count, count);
  gradient_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& own = lateness[unknown_[static_cast<std::size_t>(i)]];
    PostureVector& solved = solved_[static_cast<std::size_t>(i)];
    // Subtracts the part that the posture absorbs.
    factor.step(own.by_posture, solved);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const auto& other = lateness[unknown_[static_cast<std::size_t>(j)]];
      const double both = solved.dot(other.by_posture);
      information_(i, j) = (i == j ? own.information : 0.0) + both;
      information_(j, i) = information_(i, j);
    }
    gradient_[i] = own.gradient;
  }
}

/// Eliminates a lag that all cameras of the frame share. Only the prediction of the
/// body's movement measures it, and that is biased: it expects movements to slow down.
void CameraLags::remove_common(std::span<const TagFrameSolver::Lateness> lateness,
                               const ArrowFactor& factor) {
  // Less of the cameras' information than this is rounding.
  constexpr double kMinShare = 1e-9;
  TagFrameSolver::Lateness all;
  for (const TagFrameSolver::Lateness& one : lateness) {
    all.gradient += one.gradient;
    all.information += one.information;
    all.by_posture += one.by_posture;
  }
  PostureVector solved;
  factor.step(all.by_posture, solved);
  const double common = all.information + solved.dot(all.by_posture);
  if (!(common > kMinShare * all.information)) return;
  const auto count = static_cast<Eigen::Index>(unknown_.size());
  Vector shared(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& own = lateness[unknown_[static_cast<std::size_t>(i)]];
    shared[i] =
        own.information + solved_[static_cast<std::size_t>(i)].dot(all.by_posture);
  }
  information_ -= shared * shared.transpose() / common;
  gradient_ -= shared * (all.gradient / common);
}

/// Bounds the lags, and holds their mean at zero unless a reference determines it.
void CameraLags::hold_mean() {
  double sum_s = 0.0;
  for (const std::size_t camera : unknown_) {
    lags_s_[camera] = std::clamp(lags_s_[camera], -kMax_s, kMax_s);
    sum_s += lags_s_[camera];
  }
  if (has_reference_) return;
  const double mean_s = sum_s / static_cast<double>(unknown_.size());
  for (const std::size_t camera : unknown_) lags_s_[camera] -= mean_s;
}

void CameraLags::update(std::span<const TagFrameSolver::Lateness> lateness,
                        const ArrowFactor& factor,
                        double frame_s,
                        double since_s) {
  const auto count = static_cast<Eigen::Index>(unknown_.size());
  if (count == 0) return;
  covariance_s2_ += kDriftPerRootSecond_s * kDriftPerRootSecond_s * since_s * spread();
  measure(lateness, factor);
  remove_common(lateness, factor);
  information_ *= kIndependentShare / (frame_s * frame_s);
  gradient_ *= kIndependentShare / frame_s;
  // P' = (P^-1 + I)^-1 = P (1 + I P)^-1, which needs no inverse of P.
  const Matrix mixed = Matrix::Identity(count, count) + information_ * covariance_s2_;
  const Eigen::PartialPivLU<Matrix> factored(mixed);
  const Matrix updated = covariance_s2_ * factored.inverse();
  if (!updated.allFinite() || !gradient_.allFinite()) return;
  covariance_s2_ = 0.5 * (updated + updated.transpose());
  const Vector step = -(covariance_s2_ * gradient_);
  for (Eigen::Index i = 0; i < count; ++i) {
    lags_s_[unknown_[static_cast<std::size_t>(i)]] += step[i];
  }
  hold_mean();
}

}  // namespace marey::reconstruct
