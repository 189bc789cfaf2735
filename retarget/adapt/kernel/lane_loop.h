// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "retarget/adapt/kernel/adapt_load.h"
#include "retarget/adapt/kernel/fade_loop.h"
#include "retarget/adapt/kernel/lane_kernel.h"
#include "retarget/adapt/kernel/lane_result.h"

namespace marey::retarget {

/// Kernel for lanes of type F, `Width` of them. Lanes that are done are refilled while
/// others continue.
template <class F, int Width>
class LaneLoop final : public LaneKernel {
 public:
  explicit LaneLoop(const Plan& plan)
      : lanes_(plan), sums_(plan), result_(result_size(plan)) {
    job_.fill(-1);
  }
  [[nodiscard]] int width() const override { return Width; }

  void sift(const LaneTask& task, LaneJobs& jobs) override {
    more_ = true;
    while (more_) {
      const Mask<F> done = begin(task, jobs);
      finish(task, done, jobs);
      for (int& job : job_) {
        if (job < 0) continue;
        jobs.postpone(job);
        job = -1;
      }
      empty();
    }
  }

  void solve(const LaneTask& task, LaneJobs& jobs) override {
    more_ = true;
    while (running_ > 0 || more_) {
      // The start costs the same for one lane as for all, so it waits until several lanes
      // are empty.
      const bool fill = more_ && (running_ == 0 || Width - running_ >= kBatch);
      const Mask<F> done = fill ? begin(task, jobs) : advance(task) & running_mask();
      finish(task, done, jobs);
      if ((fill || any(done)) && running_ > 0) go_on(task);
    }
  }

  bool fade(FadeJobs& jobs) override {
    return FadeLoop<F, Width>(jobs, lanes_, solve_, sums_).run(result_.data());
  }

 private:
  // Number of empty lanes that are refilled together. Among 1, 2, 4 ... half of all lanes
  // is the fastest with balance, where every body takes steps; without balance there is
  // no difference.
  static constexpr int kBatch = Width >= 4 ? Width / 2 : 1;

  [[nodiscard]] Mask<F> running_mask() { return runs_ > num<F>(0.5); }

  void empty() {
    runs_ = num<F>(0);
    running_ = 0;
  }

  // Loads jobs into empty lanes. Returns the lanes that are done after the start.
  Mask<F> begin(const LaneTask& task, LaneJobs& jobs) {
    const Plan& plan = *task.plan;
    F fresh = num<F>(0);
    for (int lane = 0; lane < Width; ++lane) {
      int& job = job_[static_cast<std::size_t>(lane)];
      if (job >= 0) continue;
      LaneJob from;
      more_ = more_ && jobs.next(from);
      if (!more_) break;
      job = from.number;
      load_body(plan, from.body, lane, lanes_);
      load_posture(plan, from.posture, lane, lanes_);
      load_targets(plan, from.targets, lane, lanes_);
      load_balance(from.balance, lane, lanes_);
      lane_of(fresh, lane) = 1;
      lane_of(runs_, lane) = 1;
      ++running_;
    }
    const Mask<F> mask = fresh > num<F>(0.5);
    if (!any(mask)) return mask;
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

  // Returns the results of lanes that are done, and empties these lanes.
  void finish(const LaneTask& task, const Mask<F>& done, LaneJobs& jobs) {
    if (!any(done)) return;
    const Plan& plan = *task.plan;
    const Errors<F> errors =
        task.by_thesis
            ? finish_thesis(plan, *task.thesis, task.settings, done, lanes_, solve_)
            : finish_lanes(plan, task.shape, task.settings, done, lanes_, solve_);
    const LaneFigures<F> figures{
        solve_.progress.iterations, solve_.progress.capped, errors.balance};
    spread_posture(plan, lanes_);
    F is_done = select(done, num<F>(1), num<F>(0));
    for (int lane = 0; lane < Width; ++lane) {
      if (lane_of(is_done, lane) < 1) continue;
      int& job = job_[static_cast<std::size_t>(lane)];
      store_result(plan, figures, lane, lanes_, result_.data());
      jobs.answer(job, result_.data());
      job = -1;
      lane_of(runs_, lane) = 0;
      --running_;
    }
  }

  // Measures continuing lanes again, because the start of others measured them for all
  // levels.
  void go_on(const LaneTask& task) {
    if (task.by_thesis) return;
    static_cast<void>(
        measure(*task.plan, task.shape.rows.balance, solve_.progress.level, lanes_));
  }

  Lanes<F> lanes_;
  Solve<F> solve_;
  FadeSums<F> sums_;
  F runs_ = num<F>(0);
  std::vector<float> result_;
  std::array<int, Width> job_{};
  int running_ = 0;
  bool more_ = false;
};

}  // namespace marey::retarget
