// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: how late cameras are that do not say so.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "reconstruct/tag_model.h"

namespace marey::reconstruct {

/// Follows the constant lags of cameras while a body moves before them: a Kalman filter
/// beside the posture's, whose doubt it considers. No allocation once it is made.
class CameraLags {
 public:
  /// Lags of cameras that are `known` stay zero.
  explicit CameraLags(const std::vector<bool>& known);

  /// What one frame says, `since_s` after the one before and at `frame_s` per frame of
  /// `told`; `factor` is of the posture's equations where they were solved.
  void update(std::span<const TagFrameSolver::Lateness> told,
              const ArrowFactor& factor,
              double frame_s,
              double since_s);

  /// Per camera. [s]
  [[nodiscard]] std::span<const double> lags_s() const { return lags_s_; }
  [[nodiscard]] double sigma_s(std::size_t camera) const;
  [[nodiscard]] bool any() const { return !unknown_.empty(); }

  /// More are not followed.
  static constexpr std::size_t kMost = 16;

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;

  std::vector<std::size_t> unknown_;  ///< Cameras.
  std::vector<double> lags_s_;
  Matrix covariance_s2_;
  std::array<PostureVector, kMost> solved_;
};

}  // namespace marey::reconstruct
