// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "retarget/adapt/kernel/adapt_load.h"
#include "retarget/adapt/kernel/fade_mean.h"
#include "retarget/adapt/kernel/lane_kernel.h"
#include "retarget/adapt/kernel/lane_result.h"
#include "retarget/adapt/kernel/thesis_solve.h"

namespace marey::retarget {

/// Solves up to `Width` bodies whose constraints fade, each with its own number of
/// passes. A pass is one solve of every body that has it.
template <class F, int Width>
class FadeLoop {
 public:
  FadeLoop(FadeJobs& jobs, Lanes<F>& lanes, Solve<F>& solve, FadeSums<F>& sums)
      : jobs_(jobs), s_(lanes), solve_(solve), sums_(sums) {}

  /// Loads and solves one batch, and stores its results in `result`, one after the other.
  /// Returns false if there is none.
  bool run(float* result) {
    if (!load()) return false;
    clear_sums(sums_);
    figures_ = {num<F>(0), num<F>(0), num<F>(0)};
    for (int pass = 0; pass < max_passes_; ++pass) run_pass(pass);
    finish();
    for (int lane = 0; lane < count_; ++lane) {
      store_result(*task_.plan, figures_, lane, s_, result);
      jobs_.answer_faded(lane, result);
    }
    return true;
  }

 private:
  [[nodiscard]] bool load() {
    task_ = jobs_.task(0);
    const Plan& plan = *task_.plan;
    F used = num<F>(0);
    count_ = 0;
    max_passes_ = 0;
    LaneJob job;
    while (count_ < Width && jobs_.next(count_, job)) {
      load_body(plan, job.body, count_, s_);
      load_posture(plan, job.posture, count_, s_);
      load_balance(job.balance, count_, s_);
      // Supports are measured with the reference, so that targets must be finite.
      load_targets(plan, job.targets, count_, s_);
      auto& passes = passes_[static_cast<std::size_t>(count_)];
      passes = jobs_.passes(count_);
      max_passes_ = passes > max_passes_ ? passes : max_passes_;
      lane_of(used, count_) = 1;
      ++count_;
    }
    used_ = used;
    if (count_ == 0) return false;
    stand_reference(plan, task_.shape.rows.balance, used > num<F>(0.5), s_);
    return true;
  }

  // Solves the lanes that have this pass, and adds each posture to the mean as soon as it
  // is done.
  void run_pass(int pass) {
    task_ = jobs_.task(pass);
    const Plan& plan = *task_.plan;
    const F zero = num<F>(0);
    F runs = zero;
    F share = zero;
    for (int lane = 0; lane < count_; ++lane) {
      if (pass >= passes_[static_cast<std::size_t>(lane)]) continue;
      const FadeJobs::Pass part = jobs_.pass(lane, pass);
      load_targets(plan, part.targets, lane, s_);
      lane_of(share, lane) = part.share;
      lane_of(runs, lane) = 1;
    }
    const Mask<F> all = runs > zero;
    if (task_.by_thesis) {
      begin_thesis(plan, *task_.thesis, task_.settings, all, s_, solve_);
    } else {
      begin_lanes(plan, task_.shape, task_.settings, all, s_, solve_);
    }
    Mask<F> done = all & (solve_.needs_body <= zero);
    while (true) {
      if (any(done)) {
        add(done, share);
        runs = select(done, zero, runs);
      }
      if (!any(runs > zero)) return;
      if (any(done) && !task_.by_thesis) {
        static_cast<void>(
            measure(plan, task_.shape.rows.balance, solve_.progress.level, s_));
      }
      done = (runs > zero) & advance();
    }
  }

  [[nodiscard]] Mask<F> advance() {
    if (task_.by_thesis) {
      return advance_thesis(*task_.plan, *task_.thesis, task_.settings, s_, solve_);
    }
    return advance_lanes(*task_.plan, task_.shape, task_.settings, s_, solve_);
  }

  void add(const Mask<F>& done, const F& share) {
    const Plan& plan = *task_.plan;
    if (task_.by_thesis) {
      static_cast<void>(
          finish_thesis(plan, *task_.thesis, task_.settings, done, s_, solve_));
    } else {
      static_cast<void>(
          finish_lanes(plan, task_.shape, task_.settings, done, s_, solve_));
    }
    const Progress<F>& p = solve_.progress;
    figures_.iterations =
        select(done, figures_.iterations + p.iterations, figures_.iterations);
    figures_.capped = select(done, max(figures_.capped, p.capped), figures_.capped);
    add_to_mean(plan, task_.shape.rows.balance, share, done, s_, sums_);
  }

  void load_mean() {
    for (int lane = 0; lane < count_; ++lane) {
      const FadeJobs::Mean mean = jobs_.mean(lane);
      load_targets(*task_.plan, mean.targets, lane, s_);
      for (std::size_t k = 0; k < sums_.firmness.size(); ++k) {
        lane_of(sums_.firmness[k], lane) = mean.firmness[k];
      }
    }
  }

  void finish() {
    const Plan& plan = *task_.plan;
    const bool balance = task_.shape.rows.balance;
    const Mask<F> used = used_ > num<F>(0.5);
    load_mean();
    take_mean(plan, s_, sums_);
    close_mean(plan, task_.shape, task_.settings, used, s_, sums_);
    if (balance) settle_mean(plan, task_.shape, task_.settings, used, s_, sums_);
    // aim_at_mean() has overwritten the target rotations.
    load_mean();
    s_.com_target = sums_.com_target;
    const F last = num<F>(task_.shape.last_level);
    figures_.balance = measure(plan, balance, last, s_).balance;
    spread_posture(plan, s_);
  }

  FadeJobs& jobs_;
  Lanes<F>& s_;
  Solve<F>& solve_;
  FadeSums<F>& sums_;
  LaneTask task_;
  LaneFigures<F> figures_;
  F used_ = num<F>(0);
  std::array<int, Width> passes_{};
  int count_ = 0;
  int max_passes_ = 0;
};

}  // namespace marey::retarget
