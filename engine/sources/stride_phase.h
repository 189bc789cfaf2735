// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/engine/motion_clip.h"

namespace marey::engine {

/// Phases of strides, in cycles: 0 when the left foot begins to bear, 0.5 when the right
/// one does, even in between. Both functions allocate nothing.

/// Returns the phase at a time of a clip, in [0, 1); nullopt: the clip does not loop, or
/// the feet do not land in turn there. Cost: some hundred nanoseconds.
[[nodiscard]] std::optional<double> stride_phase(const MotionClip& clip, double time_s);

/// Returns a time of the clip, in its first cycle, at which the phase is `phase` (modulo
/// 1); nullopt: no such time.
[[nodiscard]] std::optional<double> time_of_stride(const MotionClip& clip, double phase);

/// Number of strides in a cycle of the clip: landings of the left foot.
[[nodiscard]] int count_strides(const MotionClip& clip);

/// The stride phase of a performer whose feet are observed step by step. Between two
/// landings it advances as in the last such step of his: it has no future.
class LeadPhase {
 public:
  void reset() { *this = LeadPhase(); }

  /// Takes the parts of the feet that bear (bits by ClipFootPart) at a time.
  /// Precondition: times ascend.
  void observe(double time_s, unsigned bears);
  /// The feet were not observed for a while: the phase is unknown until the next landing.
  void interrupt() {
    is_known_ = false;
    last_foot_ = -1;
  }
  /// Returns the phase at a time, from the last landing on; nullopt: not known before the
  /// third landing in turn, nor when the next one is late by more than half of a step.
  [[nodiscard]] std::optional<double> phase(double time_s) const;

 private:
  bool is_known_ = false;
  unsigned bears_ = 0;
  int last_foot_ = -1;  ///< Foot that landed last; -1: none.
  double last_s_ = 0.0;
  /// Time from the landing of this foot to that of the other one.
  std::optional<double> step_s_[2]{};
};

}  // namespace marey::engine
