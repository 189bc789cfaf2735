// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: postures of successive frames, from markers.

#include <optional>
#include <span>

#include "reconstruct/markers/relocalize_from_markers.h"
#include "reconstruct/posture/pose_parameter_filter.h"

namespace marey::reconstruct {

/// Tracks a body through frames. Each frame is solved from its markers and from the
/// prediction of the earlier frames. Storage is fixed after construction. Borrows the
/// model.
class MarkerFilter {
 public:
  MarkerFilter(const MarkerModel& model, FrameRate rate);

  /// Sets the initial posture; without it the first step() with enough markers finds the
  /// body.
  void start(const Posture& posture);
  [[nodiscard]] bool started() const { return started_; }

  /// Processes one frame. Does nothing while not started and without enough markers to
  /// start. Some 100 microseconds with 50 markers; ten milliseconds if the body is lost
  /// and relocalized.
  void step(std::span<const SeenMarker> seen);

  /// Estimates of the last step, before and after its markers. Precondition: a step()
  /// since the body was found.
  [[nodiscard]] const PostureEstimate& predicted() const { return predicted_; }
  [[nodiscard]] const PostureEstimate& filtered() const { return filtered_; }
  [[nodiscard]] const PostureCovariance& covariance() const { return covariance_; }
  /// Returns true if the last step lost and relocalized the body: predicted() then does
  /// not follow from the earlier frames.
  [[nodiscard]] bool is_relocalized() const { return is_relocalized_; }

  [[nodiscard]] const PoseParameterProcess& process() const { return process_; }
  [[nodiscard]] MarkerFrameSolver& solver() { return solver_; }
  /// Limits for one frame of a sequence.
  [[nodiscard]] FrameLimits limits() const;

 private:
  [[nodiscard]] bool is_lost(std::span<const SeenMarker> seen, const Posture& posture);
  void relocalize(std::span<const SeenMarker> seen, Posture& posture);

  const MarkerModel* model_;
  PoseParameterProcess process_;
  MarkerFrameSolver solver_;
  MarkerFrameSolver cost_solver_;  ///< Evaluates costs; its equations are not used.
  MarkerPoseRelocalizer relocalizer_;
  PostureEstimate predicted_;
  PostureEstimate filtered_;
  PosturePrior prior_;
  PostureCovariance covariance_;
  bool started_ = false;
  bool is_relocalized_ = false;
  int until_next_search_ = 0;
};

}  // namespace marey::reconstruct
