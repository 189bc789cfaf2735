// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "retarget/adapt_load.h"
#include "retarget/lane_kernel.h"
#include "retarget/lane_result.h"

namespace marey::retarget {

/// The kernel for lanes of type F, `Width` of them. Lanes that are done are filled again
/// while others go on.
template <class F, int Width>
class LaneLoop final : public LaneKernel {
 public:
  explicit LaneLoop(const Plan& plan) : lanes_(plan) { job_.fill(-1); }
  [[nodiscard]] int width() const override { return Width; }

  void solve(const LaneTask& task, std::span<const LaneJob> jobs) override {
    next_ = 0;
    running_ = 0;
    const int count = static_cast<int>(jobs.size());
    while (running_ > 0 || next_ < count) {
      // Beginning costs the same for one lane as for all: a few wait for each other.
      const bool fill = next_ < count && (running_ == 0 || Width - running_ >= kBatch);
      if (fill) {
        take(task, begin(task, jobs), jobs);
        continue;
      }
      take(task, advance(task) & running_mask(), jobs);
    }
  }

 private:
  static constexpr int kBatch = Width >= 4 ? Width / 4 : 1;

  [[nodiscard]] Mask<F> running_mask() { return runs_ > num<F>(0.5); }

  // Loads jobs into empty lanes. Those that are done at once.
  Mask<F> begin(const LaneTask& task, std::span<const LaneJob> jobs) {
    const Plan& plan = *task.plan;
    F fresh = num<F>(0);
    for (int lane = 0; lane < Width && next_ < static_cast<int>(jobs.size()); ++lane) {
      int& job = job_[static_cast<std::size_t>(lane)];
      if (job >= 0) continue;
      job = next_++;
      const LaneJob& from = jobs[static_cast<std::size_t>(job)];
      load_body(plan, from.body, lane, lanes_);
      load_posture(plan, from.posture, lane, lanes_);
      load_wishes(plan, from.wishes, lane, lanes_);
      load_balance(from.balance, lane, lanes_);
      lane_of(fresh, lane) = 1;
      lane_of(runs_, lane) = 1;
      ++running_;
    }
    const Mask<F> mask = fresh > num<F>(0.5);
    stand_reference(plan, task.shape.rows.balance, mask, lanes_);
    if (task.by_thesis) {
      begin_thesis(plan, *task.thesis, task.settings, mask, lanes_, solve_);
    } else {
      begin_lanes(plan, task.shape, task.settings, mask, lanes_, solve_);
    }
    return mask & (solve_.needs_body <= num<F>(0));
  }

  Mask<F> advance(const LaneTask& task) {
    if (task.by_thesis) {
      return advance_thesis(*task.plan, *task.thesis, task.settings, lanes_, solve_);
    }
    return advance_lanes(*task.plan, task.shape, task.settings, lanes_, solve_);
  }

  // Stores lanes that are done and empties them.
  void take(const LaneTask& task, const Mask<F>& done, std::span<const LaneJob> jobs) {
    const Plan& plan = *task.plan;
    if (any(done)) {
      const Errors<F> errors =
          task.by_thesis
              ? finish_thesis(plan, *task.thesis, task.settings, done, lanes_)
              : finish_lanes(plan, task.shape, task.settings, done, lanes_, solve_);
      spread_posture(plan, lanes_);
      F is_done = select(done, num<F>(1), num<F>(0));
      for (int lane = 0; lane < Width; ++lane) {
        if (lane_of(is_done, lane) < 1) continue;
        int& job = job_[static_cast<std::size_t>(lane)];
        store_result(plan,
                     errors,
                     solve_.progress.iterations,
                     lane,
                     lanes_,
                     jobs[static_cast<std::size_t>(job)].result);
        job = -1;
        lane_of(runs_, lane) = 0;
        --running_;
      }
    }
    // Those that go on measure again: others were measured with them for all levels.
    if (running_ > 0 && !task.by_thesis) {
      static_cast<void>(
          measure(plan, task.shape.rows.balance, solve_.progress.level, lanes_));
    }
  }

  Lanes<F> lanes_;
  Solve<F> solve_;
  F runs_ = num<F>(0);
  std::array<int, Width> job_{};
  int next_ = 0;
  int running_ = 0;
};

}  // namespace marey::retarget
