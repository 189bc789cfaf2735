// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "retarget/adapt_plan.h"
#include "retarget/adapt_solve.h"
#include "retarget/thesis_solve.h"

namespace marey::retarget {

/// One body's question, as packed numbers (retarget/adapt_numbers.h), and whose it is.
struct LaneJob {
  const float* body = nullptr;
  const float* posture = nullptr;
  const float* wishes = nullptr;
  const float* balance = nullptr;
  int number = -1;
};

/// What is the same for all jobs.
struct LaneTask {
  const Plan* plan = nullptr;
  Shape shape;
  SolveSettings settings;
  bool by_thesis = false;
  const ThesisShape* thesis = nullptr;
};

/// Where a kernel has its jobs from. They are packed when a lane is free for them and
/// answered when it is done, so that what one needs is in the processor's caches once.
class LaneJobs {
 public:
  LaneJobs() = default;
  LaneJobs(const LaneJobs&) = delete;
  LaneJobs& operator=(const LaneJobs&) = delete;
  virtual ~LaneJobs() = default;
  /// The next job; false: there are no more. Its numbers stay until the next call.
  [[nodiscard]] virtual bool next(LaneJob& job) = 0;
  /// The answer to a job, as store_result() has it; it stays until the next call.
  virtual void answer(int number, const float* result) = 0;
  /// A job is for later: next() of another round has it.
  virtual void postpone(int number) = 0;
};

/// Solves jobs side by side, as many as it has lanes. The answer to a job does not depend
/// on its lane, on its neighbours, or on the width: to the bit.
class LaneKernel {
 public:
  LaneKernel() = default;
  LaneKernel(const LaneKernel&) = delete;
  LaneKernel& operator=(const LaneKernel&) = delete;
  virtual ~LaneKernel() = default;
  [[nodiscard]] virtual int width() const = 0;
  /// Begins all jobs and answers those that are done with that; postpones the others.
  /// Allocates nothing. Precondition: the task's plan is the one it was made for.
  virtual void sift(const LaneTask& task, LaneJobs& jobs) = 0;
  /// Answers all jobs. Otherwise like sift().
  virtual void solve(const LaneTask& task, LaneJobs& jobs) = 0;
};

/// One body at a time; 4, 8 and 16 side by side. nullptr: not built for this processor's
/// family. Whether the processor at hand has the instructions is for the caller to ask.
[[nodiscard]] std::unique_ptr<LaneKernel> make_scalar_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_narrow_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_wide_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_widest_kernel(const Plan& plan);

}  // namespace marey::retarget
