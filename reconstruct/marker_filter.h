// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: postures of one frame after the other, from markers.

#include <optional>
#include <span>

#include "reconstruct/slot_filter.h"
#include "reconstruct/start_posture.h"

namespace marey::reconstruct {

/// Follows a body through frames: each is solved from its markers and from what the
/// frames before make expect. Storage is fixed once it is made. Borrows the model.
class MarkerFilter {
 public:
  MarkerFilter(const MarkerModel& model, FrameRate rate);

  /// Where the body is to be looked for first; without it the first step() with markers
  /// enough finds it.
  void start(const Posture& posture);
  [[nodiscard]] bool started() const { return started_; }

  /// One frame on. Until started and without markers enough to start, does nothing.
  /// Some 100 microseconds with 50 markers; ten milliseconds where the body is lost and
  /// looked for anew.
  void step(std::span<const SeenMarker> seen);

  /// Of the last step: before and after its markers. Precondition: a step() since the
  /// body was found.
  [[nodiscard]] const PostureBelief& predicted() const { return predicted_; }
  [[nodiscard]] const PostureBelief& filtered() const { return filtered_; }
  [[nodiscard]] const PostureCovariance& covariance() const { return covariance_; }
  /// The last step lost the body and found it anew: what was predicted() is then no
  /// consequence of the frames before.
  [[nodiscard]] bool found_anew() const { return found_anew_; }

  [[nodiscard]] const SlotProcess& process() const { return process_; }
  [[nodiscard]] MarkerFrameSolver& solver() { return solver_; }
  /// Of a frame among others.
  [[nodiscard]] FrameLimits limits() const;

 private:
  [[nodiscard]] bool is_lost(std::span<const SeenMarker> seen, const Posture& posture);
  void look_anew(std::span<const SeenMarker> seen, Posture& posture);

  const MarkerModel* model_;
  SlotProcess process_;
  MarkerFrameSolver solver_;
  MarkerFrameSolver judge_;  ///< Whose equations are nobody's belief.
  PostureFinder finder_;
  PostureBelief predicted_;
  PostureBelief filtered_;
  PosturePrior prior_;
  PostureCovariance covariance_;
  bool started_ = false;
  bool found_anew_ = false;
  int until_next_look_ = 0;
};

}  // namespace marey::reconstruct
