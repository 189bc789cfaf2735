// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a filter and a smoother of pose parameters over frames.
//
// The speed of every pose parameter is an Ornstein-Uhlenbeck process
// (core/human/posture_priors.h). Each parameter has a Kalman filter of its own, and a
// Rauch-Tung-Striebel smoother. The markers of a frame couple the parameters:
// MarkerFrameSolver solves them with the filter's prediction as a prior. Batch and live
// steps share this code.

#include <array>
#include <span>

#include <Eigen/Core>

#include "core/base/time.h"
#include "reconstruct/posture/pose_parameter_priors.h"
#include "reconstruct/posture/posture_equations.h"

namespace marey::reconstruct {

/// Mean and covariance of a posture and its speed. Steps are those of move_bones(), per
/// frame.
struct PostureEstimate {
  Posture posture;
  PostureVector step;
  /// Covariance of each parameter's value and step: 6 x 6, or 2 x 2 in the corner of
  /// scalars.
  std::array<Eigen::Matrix<double, 6, 6>, kPoseParameterCount> covariance;
};

/// Process noise of the filter.
struct ProcessNoiseOptions {
  /// Scale of the acceleration noise over process_of() (everyday movement). Athletes
  /// need more; a frame has enough markers to determine the movement.
  double acceleration_scale = 5.0;
  /// Time constant after which the pose priors count again in full. [s]
  double prior_memory_s = 0.5;
};

/// The filter's constants at a frame rate.
class PoseParameterProcess {
 public:
  PoseParameterProcess(const Lengths& lengths,
                       FrameRate rate,
                       const ProcessNoiseOptions& noise = {});

  /// Sets the rate of the frames that follow and converts the steps per frame.
  void change_rate(FrameRate rate, PostureEstimate& estimate);
  [[nodiscard]] FrameRate rate() const { return rate_; }

  /// Returns an initial estimate: pose known with given uncertainty, speeds distributed
  /// as in the stationary process.
  [[nodiscard]] PostureEstimate start(const Posture& posture) const;

  /// Predicts the next frame.
  void predict(const PostureEstimate& now, PostureEstimate& next) const;

  /// Converts a prediction to a prior for its frame's markers.
  static void to_prior(const PostureEstimate& predicted, PosturePrior& prior);

  /// Updates the estimate with a frame: `solved` is the posture from `predicted` and
  /// markers, with this covariance.
  void update(const PostureEstimate& predicted,
              const Posture& solved,
              const PostureCovariance& covariance,
              PostureEstimate& updated) const;

  /// Smooths one frame (Rauch, Tung & Striebel 1965): `later` is the smoothed estimate of
  /// the next frame, `predicted` its prediction from `filtered`.
  void smooth(const PostureEstimate& filtered,
              const PostureEstimate& predicted,
              const PostureEstimate& later,
              PostureEstimate& smoothed) const;

  /// Computes the leave-one-frame-out smoothed prior: `smoothed` without the information
  /// of the frame's own markers, which turned `predicted` into `filtered`.
  void from_others(const PostureEstimate& predicted,
                   const PostureEstimate& filtered,
                   const PostureEstimate& smoothed,
                   PosturePrior& prior) const;

  /// Returns the share of the pose priors' weight per frame: they count once per
  /// `prior_memory_s`.
  [[nodiscard]] double prior_share() const { return prior_share_; }

 private:
  void set_rate(FrameRate rate);
  void add_flexion(PoseParameter parameter,
                   const Posture& posture,
                   const PostureCovariance& covariance,
                   Eigen::Matrix3d& found) const;

  std::array<StepProcess, kPoseParameterCount> process_;
  Lengths lengths_;
  FrameRate rate_;
  ProcessNoiseOptions noise_;
  double prior_share_ = 1.0;
};

}  // namespace marey::reconstruct
