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
/// beside the posture's, whose covariance it considers. No allocation once it is made.
///
/// Tags show only how much later one camera is than another. A lag that all cameras of a
/// frame share cannot be told from a body that is further on in its movement, so it is
/// marginalized out of every frame. Where no camera is known, the mean of all lags is
/// held at zero: the cameras' time stamps are right on average.
class CameraLags {
 public:
  /// Lags of cameras that are `known` stay zero, and the others are relative to them.
  explicit CameraLags(const std::vector<bool>& known);

  /// Adds one frame, `since_s` after the one before and at `frame_s` per frame of `told`,
  /// which has one entry per camera; `factor` is of the posture's equations where they
  /// were solved.
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

  void measure(std::span<const TagFrameSolver::Lateness> told, const ArrowFactor& factor);
  void remove_common(std::span<const TagFrameSolver::Lateness> told,
                     const ArrowFactor& factor);
  [[nodiscard]] Matrix spread() const;
  void hold_mean();

  std::vector<std::size_t> unknown_;  ///< Cameras.
  bool has_reference_ = false;        ///< A camera whose lag is known.
  std::vector<double> lags_s_;
  Matrix covariance_s2_;
  std::array<PostureVector, kMost> solved_;
  // Of the frame that is added, per frame: how well it determines each lag, and where to.
  Matrix information_;
  Vector gradient_;
};

}  // namespace marey::reconstruct
