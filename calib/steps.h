// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: progress in steps of about equal length.

#include <algorithm>
#include <utility>

#include "core/progress.h"

namespace marey::calib {

class Steps {
 public:
  Steps() = default;
  Steps(Progress progress, int total) : progress_(std::move(progress)), total_(total) {
    report();
  }
  void step() {
    done_ = std::min(done_ + 1, total_);
    report();
  }
  /// To that step, unless it is further already.
  void reach(int done) {
    done_ = std::max(done_, std::min(done, total_));
    report();
  }
  void finish() { reach(total_); }

 private:
  void report() const {
    if (progress_) progress_(done_, total_);
  }

  Progress progress_;
  int done_ = 0;
  int total_ = 1;
};

/// Of a calibration of that many cameras: one or two solutions, two tests of other
/// hypotheses, and what cross_validate() does.
inline constexpr int kSolveSteps = 2;
[[nodiscard]] inline int calibration_steps(std::size_t cameras, bool cross_validates) {
  return kSolveSteps + 2 + (cross_validates ? 5 + static_cast<int>(cameras) : 0);
}

}  // namespace marey::calib
