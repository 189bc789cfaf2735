// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "retarget/adapt_plan.h"
#include "retarget/adapt_solve.h"
#include "retarget/thesis_solve.h"

namespace marey::retarget {

/// One body's question, as packed numbers (retarget/adapt_numbers.h), and where its
/// answer goes (retarget/lane_result.h).
struct LaneJob {
  const float* body = nullptr;
  const float* posture = nullptr;
  const float* wishes = nullptr;
  const float* balance = nullptr;
  float* result = nullptr;
};

/// What is the same for all jobs.
struct LaneTask {
  const Plan* plan = nullptr;
  Shape shape;
  SolveSettings settings;
  bool by_thesis = false;
  const ThesisShape* thesis = nullptr;
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
  /// Allocates nothing. Precondition: the task's plan is the one it was made for.
  virtual void solve(const LaneTask& task, std::span<const LaneJob> jobs) = 0;
};

/// One body at a time; 4, 8 and 16 side by side. nullptr: not built for this processor's
/// family. Whether the processor at hand has the instructions is for the caller to ask.
[[nodiscard]] std::unique_ptr<LaneKernel> make_scalar_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_narrow_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_wide_kernel(const Plan& plan);
[[nodiscard]] std::unique_ptr<LaneKernel> make_widest_kernel(const Plan& plan);

}  // namespace marey::retarget
