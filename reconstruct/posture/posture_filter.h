// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the filter of postures over frames, for any kind of
// observations.

#include <optional>

#include "reconstruct/posture/pose_parameter_filter.h"
#include "reconstruct/posture/posture_descent.h"

namespace marey::reconstruct {

/// Tracks a body through frames: predicts a frame's posture, solves it from the
/// observations, and updates the estimate. Storage is fixed after construction.
///
/// `Filter` derives from this class and defines the observation model, for a frame of
/// observations:
///   std::optional<Posture> find(frame)   the posture without a prior; nullopt: none
///   void predict(frame)                  fills in predicted_ from filtered_
///   void solve(frame, posture)           moves the predicted posture to the solution
///   void repair(frame, posture)          relocalizes a posture that does not fit
/// `Solver` solves single frames; it keeps the factored equations of its last solution.
template <class Filter, class Solver>
class PostureFilter {
 public:
  [[nodiscard]] bool started() const { return started_; }

  /// Estimates of the last frame, before and after its observations. Precondition of
  /// these functions: a frame since the body was found.
  [[nodiscard]] const PostureEstimate& predicted() const { return predicted_; }
  [[nodiscard]] const PostureEstimate& filtered() const { return filtered_; }
  [[nodiscard]] const PostureCovariance& covariance() const { return covariance_; }

  [[nodiscard]] const PoseParameterProcess& process() const { return process_; }
  [[nodiscard]] Solver& solver() { return solver_; }
  /// Limits for one frame of a sequence.
  [[nodiscard]] FrameLimits limits() const {
    FrameLimits limits;
    limits.prior_share = process_.prior_share();
    return limits;
  }

 protected:
  template <class Model>
  PostureFilter(const Model& model, FrameRate rate, const ProcessNoiseOptions& noise = {})
      : process_(model.lengths, rate, noise), solver_(model) {}

  /// Starts again from a posture that was found without a prior.
  void restart(const Posture& posture) {
    predicted_ = process_.start(posture);
    started_ = true;
  }

  /// Processes one frame. Returns false if the body is not found yet; `posture` is then
  /// unchanged, otherwise it is the solution.
  template <class Frame>
  bool process_frame(const Frame& frame, Posture& posture) {
    Filter& filter = static_cast<Filter&>(*this);
    if (started_) {
      filter.predict(frame);
    } else {
      const std::optional<Posture> found = filter.find(frame);
      if (!found) return false;
      filter.restart(*found);
    }
    posture = predicted_.posture;
    filter.solve(frame, posture);
    filter.repair(frame, posture);
    solver_.factor().covariance(covariance_);
    process_.update(predicted_, posture, covariance_, filtered_);
    return true;
  }

  PoseParameterProcess process_;
  Solver solver_;
  PostureEstimate predicted_;
  PostureEstimate filtered_;
  PosturePrior prior_;
  PostureCovariance covariance_;
  bool started_ = false;
};

}  // namespace marey::reconstruct
