// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/constraint.h"

namespace marey::retarget {

/// How far a constraint is active at `time_s`, from 0 to 1 (Kulpa 2005, 3.1.1.5, figure
/// 3.8).
///
/// Two quintic ramps (retarget/smooth_step.h), one up from the start and one down from
/// the stop, multiplied: the product of C2 functions is C2, so that a constraint which
/// stops before it was fully active turns round without a jerk, below 1. (Their minimum
/// would have a kink there.) Where the ramps do not overlap it is the figure's.
///
/// A duration of 0 is a step: active from the start on, that moment included, and not any
/// more from the stop on, so that of two constraints that hand over exactly one holds.
///
/// Precondition: finite; durations >= 0.
[[nodiscard]] double activation(const Activation& when, double time_s);

/// The same of a constraint that is started and stopped while things happen (Kulpa 2005,
/// 3.1.1.5): whenever that is, also in the middle of a ramp, the activation goes on from
/// where it is, with continuous speed and acceleration. Every start r makes the
/// activation a to 1 - (1 - a)(1 - r), every stop to a (1 - r). Without any it is
/// activation(), to rounding. Allocates nothing.
class LiveActivation {
 public:
  /// As it was planned. Precondition: as activation()'s.
  explicit LiveActivation(const Activation& planned);

  /// Begins to fade in, or out, at `time_s`; what was to happen later is forgotten.
  /// Nothing happens when it does so already. Precondition: finite.
  void start(double time_s);
  void stop(double time_s);

  /// From 0 to 1. Precondition: finite.
  [[nodiscard]] double at(double time_s) const;

 private:
  struct Change {
    double time_s = 0.0;
    bool starts = false;
  };
  void change(const Change& wanted);
  [[nodiscard]] double ramp_of(const Change& change, double time_s) const;

  std::size_t count_ = 0;
  bool was_active_ = false;  ///< Before all changes.
  double start_duration_s_;
  double stop_duration_s_;
  // Full only when somebody starts and stops within the durations again and again; then
  // the oldest is taken for done, which it nearly is.
  std::array<Change, 16> changes_{};
};

}  // namespace marey::retarget
