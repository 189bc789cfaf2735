// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/time.h"

namespace marey::app {

/// Schedules fixed steps against a clock. Step k after a start is due k / rate seconds
/// after it, so that rounding never adds up. Reads no clock itself. Used by one thread.
class StepClock {
 public:
  /// At most `max_catch_up` steps are due at once; older ones are skipped, so that a
  /// delay is followed by no burst of steps. Preconditions: rate above 0, max_catch_up
  /// at least 1.
  StepClock(double rate_hz, int max_catch_up);

  /// Begins, or continues after a pause: the next step is due one period after `now`.
  void start(Timestamp now);

  /// Returns the number of steps that are due at `now` and were not returned before.
  /// A `now` before an earlier one returns 0.
  [[nodiscard]] int take_due(Timestamp now);

  /// Returns the time at which the next `steps` steps are due.
  [[nodiscard]] Timestamp next(int steps = 1) const;

  /// Returns the number of steps skipped since the construction.
  [[nodiscard]] std::int64_t skipped() const { return skipped_; }

 private:
  [[nodiscard]] Timestamp due(std::int64_t step) const;

  double period_ns_;
  int max_catch_up_;
  Timestamp start_{0};
  std::int64_t done_ = 0;  ///< Steps since the start, with skipped ones.
  std::int64_t skipped_ = 0;
};

}  // namespace marey::app
