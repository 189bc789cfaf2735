// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "retarget/adapt/kernel/adapt_solve.h"
#include "retarget/adapt/kernel/thesis_solve.h"
#include "retarget/adapt/plan/adapt_plan.h"

namespace marey::retarget {

/// Input of one body as packed numbers (retarget/adapt/plan/adapt_numbers.h), with the
/// number of the body.
struct LaneJob {
  const float* body = nullptr;
  const float* posture = nullptr;
  const float* targets = nullptr;
  const float* balance = nullptr;
  int number = -1;
};

/// Settings common to all jobs.
struct LaneTask {
  const Plan* plan = nullptr;
  Shape shape;
  SolveSettings settings;
  bool by_thesis = false;
  const ThesisShape* thesis = nullptr;
};

/// Source of a kernel's jobs and receiver of its results. A job is packed when a lane
/// becomes free and its result is read when the lane is done, so that its data passes
/// through the caches once.
class LaneJobs {
 public:
  LaneJobs() = default;
  LaneJobs(const LaneJobs&) = delete;
  LaneJobs& operator=(const LaneJobs&) = delete;
  virtual ~LaneJobs() = default;
  /// Gets the next job; returns false if there are no more. Its numbers are valid until
  /// the next call.
  [[nodiscard]] virtual bool next(LaneJob& job) = 0;
  /// Receives the result of a job in the form of store_result(), valid until the next
  /// call.
  virtual void answer(int number, const float* result) = 0;
  /// Postpones a job: next() of a later round returns it.
  virtual void postpone(int number) = 0;
};

/// Source of the jobs of bodies whose constraints fade, in batches of one body per lane.
class FadeJobs {
 public:
  /// One solve of a body.
  struct Pass {
    const float* targets = nullptr;
    float share = 0.0F;  ///< Weight of its posture in the mean.
  };
  /// Targets that the mean posture is closed on.
  struct Mean {
    const float* targets = nullptr;
    const float* firmness = nullptr;  ///< FadeSums::firmness.
  };
  FadeJobs() = default;
  FadeJobs(const FadeJobs&) = delete;
  FadeJobs& operator=(const FadeJobs&) = delete;
  virtual ~FadeJobs() = default;
  /// Returns the inputs common to all bodies in a pass.
  [[nodiscard]] virtual LaneTask task(int pass) = 0;
  /// Gets the next body, for a lane of the batch; returns false if there are no more.
  /// Numbers are valid until the next call.
  [[nodiscard]] virtual bool next(int lane, LaneJob& job) = 0;
  /// Returns the number of passes of the body in a lane.
  [[nodiscard]] virtual int passes(int lane) = 0;
  /// Returns one of its passes, valid until the next call.
  [[nodiscard]] virtual Pass pass(int lane, int number) = 0;
  [[nodiscard]] virtual Mean mean(int lane) = 0;
  /// Receives the result of a lane in the form of store_result(), valid until the next
  /// call.
  virtual void answer_faded(int lane, const float* result) = 0;
};

/// Solves jobs in parallel, one per lane. The result of a job is independent of its lane,
/// of the other lanes and of the width, to the bit.
class LaneKernel {
 public:
  LaneKernel() = default;
  LaneKernel(const LaneKernel&) = delete;
  LaneKernel& operator=(const LaneKernel&) = delete;
  virtual ~LaneKernel() = default;
  [[nodiscard]] virtual int width() const = 0;
  /// Starts all jobs. Returns the results of jobs that finish at the start, and postpones
  /// the others. Allocates nothing. Precondition: the task's plan is the plan that the
  /// kernel was made for.
  virtual void sift(const LaneTask& task, LaneJobs& jobs) = 0;
  /// Solves all jobs. Otherwise like sift().
  virtual void solve(const LaneTask& task, LaneJobs& jobs) = 0;
  /// Solves one batch of bodies whose constraints fade. Returns false if there is none.
  virtual bool fade(FadeJobs& jobs) = 0;
};

/// Create kernels for 1, 4, 8 and 16 bodies in parallel. nullptr: not built for this
/// processor family. The caller must check that the processor supports the instructions.
[[nodiscard]] std::unique_ptr<LaneKernel> make_scalar_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_narrow_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_wide_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_widest_kernel(const Plan& plan);

}  // namespace marey::retarget
