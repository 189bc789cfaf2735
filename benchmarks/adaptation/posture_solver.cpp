// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/posture_solver.h"

#include <utility>

namespace marey {
namespace {

class Baseline final : public PostureSolver {
 public:
  explicit Baseline(std::unique_ptr<GaussNewtonBaseline> solver)
      : solver_(std::move(solver)) {}
  void load(const PostureTask& task) override { solver_->load(*task.reference); }
  int solve(const PostureTask& task) override {
    return solver_->solve(task.targets_in_world, task.com_in_world);
  }
  void store(Pose& out) const override { solver_->store(out); }

 private:
  std::unique_ptr<GaussNewtonBaseline> solver_;
};

template <BaselineKind kind>
std::unique_ptr<PostureSolver> make_baseline(const PostureProblem& problem) {
  return std::make_unique<Baseline>(GaussNewtonBaseline::make(kind,
                                                              problem.character->skeleton,
                                                              problem.character->masses,
                                                              problem.goals,
                                                              problem.with_balance));
}

}  // namespace

std::vector<SolverKind> baseline_solvers() {
  return {{"GN dual float", make_baseline<BaselineKind::kDualFloat>},
          {"GN dual double", make_baseline<BaselineKind::kDualDouble>},
          {"GN strict double", make_baseline<BaselineKind::kStrictDouble>}};
}

}  // namespace marey
