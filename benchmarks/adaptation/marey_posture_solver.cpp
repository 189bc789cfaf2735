// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/marey_posture_solver.h"

#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace marey {
namespace {

using retarget::Adapter;
using retarget::AdaptOptions;
using retarget::Method;

class MareySolver final : public PostureSolver {
 public:
  MareySolver(Adapter adapter, std::size_t goals) : adapter_(std::move(adapter)) {
    for (std::size_t k = 0; k < goals; ++k) {
      handles_.push_back(*adapter_.constraint(goal_id(k)));
    }
  }

  void load(const PostureTask& task) override { (void)task; }
  int solve(const PostureTask& task) override {
    for (std::size_t k = 0; k < handles_.size(); ++k) {
      handles_[k].set_target(task.targets_in_world[k]);
    }
    adapter_.set_balance_target(task.com_in_world);
    return adapter_.adapt(*task.reference, 0.0, found_).iterations;
  }
  void store(Pose& out) const override { out = found_; }

 private:
  Adapter adapter_;
  std::vector<Adapter::Handle> handles_;  // Goals of `adapter_`.
  Pose found_;
};

template <Method method>
std::unique_ptr<PostureSolver> make_default(const PostureProblem& problem) {
  AdaptOptions options;
  options.method = method;
  return make_marey_solver(problem, options);
}

}  // namespace

std::string goal_id(std::size_t k) {
  return "goal " + std::to_string(k);
}

ConstraintSet marey_constraints(const PostureProblem& problem, double precision_m) {
  ConstraintSet set;
  for (std::size_t k = 0; k < problem.goals.size(); ++k) {
    const PointGoal& goal = problem.goals[k];
    Constraint constraint;
    constraint.id = goal_id(k);
    constraint.point.segment = problem.character->skeleton[goal.joint].name;
    constraint.precision_m = precision_m;
    if (goal.is_planted) {
      // The same goal as the baselines': the ankle's position, not the foot's rotation.
      constraint.goal = Support{std::nullopt, std::nullopt, true};
    } else {
      constraint.goal = DistanceToPoint{};
    }
    set.constraints.push_back(std::move(constraint));
  }
  return set;
}

std::unique_ptr<PostureSolver> make_marey_solver(const PostureProblem& problem,
                                                 const AdaptOptions& options,
                                                 double precision_m) {
  AdaptOptions asked = options;
  if (problem.with_balance) asked.balance = retarget::BalanceMode::kHorizontal;
  auto adapter =
      Adapter::make(*problem.character, marey_constraints(problem, precision_m), asked);
  if (!adapter) {
    std::fprintf(stderr, "%s\n", adapter.error().message().c_str());
    std::exit(2);
  }
  return std::make_unique<MareySolver>(*std::move(adapter), problem.goals.size());
}

std::vector<SolverKind> marey_solvers() {
  return {{"marey strict", make_default<Method::kStrict>},
          {"marey thesis", make_default<Method::kThesis>}};
}

}  // namespace marey
