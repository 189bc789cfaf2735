// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/constraint.h"

namespace marey::retarget {

/// Returns the activation of a constraint at `time_s`, from 0 to 1 (Kulpa 2005, 3.1.1.5,
/// figure 3.8).
///
/// The product of two quintic ramps (core/base/smooth_step.h), one up from the start
/// and one down from the stop. The product of C2 functions is C2, so that a constraint
/// that stops before it is fully active reverses smoothly below 1. (The minimum of the
/// ramps would have a kink there.) Where the ramps do not overlap it equals the figure.
///
/// A duration of 0 is a step: active from the start (inclusive) to the stop (exclusive),
/// so that of two consecutive constraints exactly one holds.
///
/// Precondition: finite; durations >= 0.
[[nodiscard]] double activation(const Activation& when, double time_s);

/// Activation of a constraint that is started and stopped at run time (Kulpa 2005,
/// 3.1.1.5). At any time, also within a ramp, the activation continues from its current
/// value with continuous speed and acceleration. Every start r changes the activation a
/// to 1 - (1 - a)(1 - r), every stop to a (1 - r). Without changes it equals activation()
/// to rounding. Allocates nothing.
class LiveActivation {
 public:
  /// Starts with the planned activation. Precondition: as activation().
  explicit LiveActivation(const Activation& planned);

  /// Fades in or out from `time_s` on, and discards later changes. No effect if the
  /// constraint already does so. Precondition: finite.
  void start(double time_s);
  void stop(double time_s);

  /// Multiplies the activation by this from now on: 0 to 1, at first 1. The caller moves
  /// it continuously.
  void set_share(double share) { share_ = share; }

  /// Returns the activation, 0 to 1. Precondition: finite.
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
  double share_ = 1.0;
  // Full only after many starts and stops within the durations; then the oldest is
  // treated as complete, which it nearly is.
  std::array<Change, 16> changes_{};
};

}  // namespace marey::retarget
