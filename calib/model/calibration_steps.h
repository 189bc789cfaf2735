// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: progress in steps of about equal length.

#include <algorithm>
#include <utility>

#include "core/base/progress.h"

namespace marey::calib {

/// Each step is reported as kParts.
class Steps {
 public:
  static constexpr int kParts = 10;

  Steps() = default;
  Steps(Progress progress, int total) : progress_(std::move(progress)), total_(total) {
    report();
  }
  void step() { reach(done_ + 1); }
  /// Advances to that step, unless the progress is already further.
  void reach(int done) {
    const int reached = std::max(done_, std::min(done, total_));
    if (reached > done_) parts_ = ticks_ = 0;
    done_ = reached;
    report();
  }
  void finish() { reach(total_); }
  /// Reports progress within a step of unknown length: one part after two calls, the next
  /// after twice as many, and never the whole step.
  void tick() {
    constexpr int kFirstPart = 2;
    if (done_ == total_ || parts_ == kParts - 1) return;
    if (++ticks_ < kFirstPart << parts_) return;
    ++parts_;
    ticks_ = 0;
    report();
  }

 private:
  void report() const {
    if (progress_) progress_(kParts * done_ + parts_, kParts * total_);
  }

  Progress progress_;
  int done_ = 0;
  int total_ = 1;
  int parts_ = 0;  ///< Parts of the present step.
  int ticks_ = 0;  ///< Calls in the present part.
};

/// Steps of a calibration of that many cameras: one or two solutions, two tests of other
/// hypotheses, and the steps of cross_validate().
inline constexpr int kSolveSteps = 2;
[[nodiscard]] inline int calibration_steps(std::size_t cameras, bool cross_validates) {
  return kSolveSteps + 2 + (cross_validates ? 5 + static_cast<int>(cameras) : 0);
}

}  // namespace marey::calib
