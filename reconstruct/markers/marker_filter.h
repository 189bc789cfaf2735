// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: postures of successive frames, from markers.

#include <optional>
#include <span>

#include "reconstruct/markers/relocalize_from_markers.h"
#include "reconstruct/posture/posture_filter.h"

namespace marey::reconstruct {

/// Tracks a body through frames of markers. Borrows the model.
class MarkerFilter : public PostureFilter<MarkerFilter, MarkerFrameSolver> {
 public:
  MarkerFilter(const MarkerModel& model, FrameRate rate);

  /// Sets the initial posture; without it the first step() with enough markers finds the
  /// body.
  void start(const Posture& posture);

  /// Processes one frame. Does nothing while not started and without enough markers to
  /// start. Some 100 microseconds with 50 markers; ten milliseconds if the body is lost
  /// and relocalized.
  void step(std::span<const SeenMarker> seen);

  /// Returns true if the last step lost and relocalized the body: predicted() then does
  /// not follow from the earlier frames.
  [[nodiscard]] bool is_relocalized() const { return is_relocalized_; }

 private:
  friend PostureFilter;
  using Markers = std::span<const SeenMarker>;

  [[nodiscard]] std::optional<Posture> find(Markers seen);
  void predict(Markers) { process_.predict(filtered_, predicted_); }
  void solve(Markers seen, Posture& posture);
  void repair(Markers seen, Posture& posture);
  [[nodiscard]] bool is_lost(Markers seen, const Posture& posture);

  const MarkerModel* model_;
  MarkerFrameSolver cost_solver_;  ///< Evaluates costs; its equations are not used.
  MarkerPoseRelocalizer relocalizer_;
  bool is_relocalized_ = false;
  int until_next_search_ = 0;
};

}  // namespace marey::reconstruct
