// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// This file and gauss_newton_baseline_float.cpp and gauss_newton_baseline_double.cpp are
// compiled for the processor at hand (benchmarks/CMakeLists.txt), so that the compiler
// options of marey do not slow down the baselines.
#include "benchmarks/baseline/gauss_newton_solver.h"

namespace marey {
namespace {

using namespace gauss_newton;

/// Solves level 1 first, then level 2 within the null space of level 1.
class StrictSolver final : public Solver<double> {
 public:
  StrictSolver(const Skeleton& skeleton,
               const std::vector<PointMass>& masses,
               std::span<const PointGoal> goals,
               bool with_balance)
      : Solver(skeleton, masses, goals, with_balance) {
    const auto planted = std::count_if(
        goals.begin(), goals.end(), [](const PointGoal& g) { return g.is_planted; });
    planted_ = static_cast<Eigen::Index>(planted);
    first_.setZero(3 * planted_ + (with_balance ? 2 : 0), columns_);
    first_error_.setZero(first_.rows());
    second_.setZero(3 * (static_cast<Eigen::Index>(goals.size()) - planted_), columns_);
    second_error_.setZero(second_.rows());
  }

  int solve(std::span<const glm::dvec3> targets_in_world,
            const glm::dvec3& com_in_world) override {
    trial_ = reference_;
    double min_m = 1e9;
    int stalled = 0;
    int step = 0;
    for (; step < kMaxSteps; ++step) {
      body_.forward(trial_);
      const double second_worst_m = measure(targets_in_world, com_in_world);
      // The residual of level 1 is added because stand_exactly() moves all points with
      // the root.
      const double worst_m = first_worst_m_ + second_worst_m;
      stalled = worst_m > min_m * 0.998 ? stalled + 1 : 0;
      if (worst_m < min_m || worst_m < kGoodEnough_m) {
        min_m = worst_m;
        found_ = trial_;
      }
      if (worst_m < kGoodEnough_m || stalled >= 4) break;
      find_step(second_worst_m > 0.5 ? 3e-2 : 1e-4);
      body_.apply(step_, trial_);
    }
    stand_exactly(targets_in_world);
    return step;
  }

 private:
  static constexpr int kMaxSteps = 48;
  static constexpr double kMaxLean_m = 0.2;

  /// Fills the errors of both levels. Returns the largest error of level 2. [m]
  double measure(std::span<const glm::dvec3> targets, const glm::dvec3& com) {
    first_worst_m_ = 0.0;
    double second_worst_m = 0.0;
    Eigen::Index row[2] = {0, 0};
    for (std::size_t k = 0; k < goals_.size(); ++k) {
      const Vec3 off = Body::vec(targets[k]) - body_.place(goals_[k].joint);
      const double length = off.norm();
      if (goals_[k].is_planted) {
        first_worst_m_ = std::max(first_worst_m_, length);
        first_error_.segment<3>(row[0]) = off;
        row[0] += 3;
      } else {
        second_worst_m = std::max(second_worst_m, length);
        second_error_.segment<3>(row[1]) = shortened(off, length, kMaxPull_m);
        row[1] += 3;
      }
    }
    if (with_balance_) {
      Vec3 off = Body::vec(com) - body_.centre_of_mass();
      off[1] = 0.0;
      const double length = off.norm();
      first_worst_m_ = std::max(first_worst_m_, length);
      off = shortened(off, length, kMaxLean_m);
      first_error_[row[0]] = off[0];
      first_error_[row[0] + 1] = off[2];
    }
    return second_worst_m;
  }

  void find_step(double damping) {
    second_.setZero();
    Eigen::Index row[2] = {0, 0};
    for (const PointGoal& goal : goals_) {
      Eigen::Index& at = row[goal.is_planted ? 0 : 1];
      body_.point_rows(
          goal.joint,
          1.0,
          goal.is_planted ? first_.middleRows<3>(at) : second_.middleRows<3>(at));
      at += 3;
    }
    if (with_balance_) body_.balance_rows(first_.middleRows<2>(row[0]));
    normal_.noalias() = first_ * first_.transpose();
    normal_.diagonal().array() += 1e-9;
    factor_.compute(normal_);
    first_step_.noalias() = first_.transpose() * factor_.solve(first_error_);
    // Projects level 2 into the null space of level 1. Subtracts the effect of level 1's
    // step from the errors of level 2.
    shared_.noalias() = first_ * second_.transpose();
    factor_.solveInPlace(shared_);
    second_error_.noalias() -= second_ * first_step_;
    second_.noalias() -= shared_.transpose() * first_;
    normal_.noalias() = second_ * second_.transpose();
    normal_.diagonal().array() += damping;
    factor_.compute(normal_);
    step_ = first_step_;
    step_.noalias() += second_.transpose() * factor_.solve(second_error_);
  }

  /// Shifts the root by the mean error of the planted points.
  void stand_exactly(std::span<const glm::dvec3> targets) {
    if (planted_ == 0) return;
    body_.forward(found_);
    Vec3 off = Vec3::Zero();
    for (std::size_t k = 0; k < goals_.size(); ++k) {
      if (goals_[k].is_planted)
        off += Body::vec(targets[k]) - body_.place(goals_[k].joint);
    }
    found_.root += off / static_cast<double>(planted_);
  }

  Eigen::Index planted_ = 0;
  double first_worst_m_ = 0.0;
  Body::Posture trial_;
  Matrix first_;
  Matrix second_;
  Matrix shared_;
  Matrix normal_;
  Vector first_error_;
  Vector second_error_;
  Vector first_step_;
  Vector step_;
  Eigen::LLT<Matrix> factor_;
};

}  // namespace

std::unique_ptr<GaussNewtonBaseline> GaussNewtonBaseline::make(
    BaselineKind kind,
    const Skeleton& skeleton,
    const std::vector<PointMass>& masses,
    std::span<const PointGoal> goals,
    bool with_balance) {
  switch (kind) {
    case BaselineKind::kDualFloat:
      return make_dual<float>(skeleton, masses, goals, with_balance);
    case BaselineKind::kDualDouble:
      return make_dual<double>(skeleton, masses, goals, with_balance);
    case BaselineKind::kStrictDouble:
      break;
  }
  return std::make_unique<StrictSolver>(skeleton, masses, goals, with_balance);
}

}  // namespace marey
