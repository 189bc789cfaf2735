// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/camera_lags.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace marey::reconstruct {
namespace {

// Webcams that start together are within a frame of each other.
constexpr double kFirstSigma_s = 0.02;
// Clocks drift by some tens of microseconds in a second; groups of frames by more.
constexpr double kDriftPerRootSecond_s = 2e-4;
// Frames that follow each other share their mistakes: together they say less.
constexpr double kShare = 0.3;
// A camera is no later than this, whatever a blunder says.
constexpr double kMost_s = 0.03;

}  // namespace

CameraLags::CameraLags(const std::vector<bool>& known) : lags_s_(known.size(), 0.0) {
  for (std::size_t c = 0; c < known.size(); ++c) {
    if (!known[c] && unknown_.size() < kMost) unknown_.push_back(c);
  }
  const auto count = static_cast<Eigen::Index>(unknown_.size());
  covariance_s2_ = Matrix::Identity(count, count) * kFirstSigma_s * kFirstSigma_s;
}

double CameraLags::sigma_s(std::size_t camera) const {
  const auto it = std::find(unknown_.begin(), unknown_.end(), camera);
  if (it == unknown_.end()) return 0.0;
  const auto at = static_cast<Eigen::Index>(it - unknown_.begin());
  return std::sqrt(std::max(0.0, covariance_s2_(at, at)));
}

void CameraLags::update(std::span<const TagFrameSolver::Lateness> told,
                        const ArrowFactor& factor,
                        double frame_s,
                        double since_s) {
  const auto count = static_cast<Eigen::Index>(unknown_.size());
  if (count == 0) return;
  covariance_s2_.diagonal().array() +=
      kDriftPerRootSecond_s * kDriftPerRootSecond_s * since_s;
  const double per_s = kShare / (frame_s * frame_s);
  Matrix information(count, count);
  Vector gradient(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& own = told[unknown_[static_cast<std::size_t>(i)]];
    PostureVector& solved = solved_[static_cast<std::size_t>(i)];
    // Minus what the posture gives way by.
    factor.step(own.by_posture, solved);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const auto& other = told[unknown_[static_cast<std::size_t>(j)]];
      const double both = solved.dot(other.by_posture);
      information(i, j) = per_s * ((i == j ? own.information : 0.0) + both);
      information(j, i) = information(i, j);
    }
    gradient[i] = kShare / frame_s * own.gradient;
  }
  // P' = (P^-1 + I)^-1 = P (1 + I P)^-1, which needs no inverse of P.
  const Matrix mixed = Matrix::Identity(count, count) + information * covariance_s2_;
  const Eigen::PartialPivLU<Matrix> factored(mixed);
  const Matrix updated = covariance_s2_ * factored.inverse();
  if (!updated.allFinite()) return;
  covariance_s2_ = 0.5 * (updated + updated.transpose());
  const Vector step = -(covariance_s2_ * gradient);
  for (Eigen::Index i = 0; i < count; ++i) {
    double& lag_s = lags_s_[unknown_[static_cast<std::size_t>(i)]];
    lag_s = std::clamp(lag_s + step[i], -kMost_s, kMost_s);
  }
}

}  // namespace marey::reconstruct
