// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: estimates the lags of cameras whose lag is not given.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "reconstruct/tags/tag_model.h"

namespace marey::reconstruct {

/// Tracks the constant lags of cameras while a body moves in front of them: a Kalman
/// filter that runs next to the posture's filter and uses its covariance. Does not
/// allocate after construction.
/// Tags show only the differences between the cameras' lags. A lag that all cameras of a
/// frame share is indistinguishable from a body that is further on in its movement, so it
/// is marginalized out of every frame. If the lag of no camera is known, the mean of all
/// lags is held at zero: the cameras' time stamps are right on average.
class CameraLags {
 public:
  /// Lags of cameras that are `known` stay zero; the other lags are relative to them.
  explicit CameraLags(const std::vector<bool>& known);

  /// Adds one frame, `since_s` after the previous one. `lateness` has one entry per
  /// camera and is in frames of `frame_s` seconds. `factor` is the factored equations of
  /// the posture at its solution.
  void update(std::span<const TagFrameSolver::Lateness> lateness,
              const ArrowFactor& factor,
              double frame_s,
              double since_s);

  /// Estimated lag per camera. [s]
  [[nodiscard]] std::span<const double> lags_s() const { return lags_s_; }
  [[nodiscard]] double sigma_s(std::size_t camera) const;
  [[nodiscard]] bool any() const { return !unknown_.empty(); }

  /// Maximum number of cameras whose lags are estimated.
  static constexpr std::size_t kMax = 16;

 private:
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMax, kMax>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMax, 1>;

  void measure(std::span<const TagFrameSolver::Lateness> lateness,
               const ArrowFactor& factor);
  void remove_common(std::span<const TagFrameSolver::Lateness> lateness,
                     const ArrowFactor& factor);
  [[nodiscard]] Matrix spread() const;
  void hold_mean();

  std::vector<std::size_t> unknown_;  ///< Cameras with unknown lag.
  bool has_reference_ = false;        ///< True if the lag of any camera is known.
  std::vector<double> lags_s_;
  Matrix covariance_s2_;
  std::array<PostureVector, kMax> solved_;
  // Information on each lag, and gradient, per frame of lag, in the frame that is being
  // added.
  Matrix information_;
  Vector gradient_;
};

}  // namespace marey::reconstruct
