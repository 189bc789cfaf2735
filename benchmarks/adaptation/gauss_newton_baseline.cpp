// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// This file is compiled for the processor at hand (benchmarks/CMakeLists.txt), so that
// the compiler options of marey do not slow down the baselines.
#include "benchmarks/adaptation/gauss_newton_baseline.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/markers/ball_joint_body.h"
#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Geometry>

namespace marey {
namespace {

constexpr double kGoodEnough_m = 1e-3;
constexpr double kLongestPull_m = 0.3;  // Limit of a point's error in one step.
constexpr double kPlantedWeight = 5.0;

/// Base of both solvers: a body, its goals, and input and output of postures.
template <class T>
class Solver : public GaussNewtonBaseline {
 public:
  Solver(const Skeleton& skeleton,
         const std::vector<PointMass>& masses,
         std::span<const PointGoal> goals,
         bool with_balance)
      : body_(skeleton, masses),
        goals_(goals.begin(), goals.end()),
        with_balance_(with_balance),
        columns_(static_cast<Eigen::Index>(3 + 3 * skeleton.joints.size())) {}

  void load(const Pose& reference) override {
    reference_.root = Body::vec(reference.root_in_world);
    reference_.parent_from_joint.resize(reference.parent_from_joint.size());
    for (std::size_t i = 0; i < body_.size(); ++i) {
      const glm::dquat& q = reference.parent_from_joint[i];
      reference_.parent_from_joint[i] =
          Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix().template cast<T>();
    }
  }

  void store(Pose& out) const override {
    const auto root = found_.root.template cast<double>();
    out.root_in_world = {root[0], root[1], root[2]};
    out.parent_from_joint.resize(body_.size());
    for (std::size_t i = 0; i < body_.size(); ++i) {
      const Eigen::Quaterniond q(found_.parent_from_joint[i].template cast<double>());
      const Eigen::Quaterniond unit = q.normalized();
      out.parent_from_joint[i] = {unit.w(), unit.x(), unit.y(), unit.z()};
    }
  }

 protected:
  using Body = BallJointBody<T>;
  using Vec3 = typename Body::Vec3;
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  static Vec3 shortened(const Vec3& error, T length, T longest) {
    return length > longest ? Vec3(error * (longest / length)) : error;
  }

  Body body_;
  std::vector<PointGoal> goals_;
  bool with_balance_;
  Eigen::Index columns_;
  typename Body::Posture reference_;
  typename Body::Posture found_;
};

/// A number of rows known at compile time saves a tenth of the time. Surplus rows stay
/// zero.
template <class T, int Rows>
class DualSolver final : public Solver<T> {
 public:
  using Base = Solver<T>;
  DualSolver(const Skeleton& skeleton,
             const std::vector<PointMass>& masses,
             std::span<const PointGoal> goals,
             bool with_balance)
      : Base(skeleton, masses, goals, with_balance) {
    const auto needed =
        static_cast<Eigen::Index>(3 * goals.size() + (with_balance ? 2 : 0));
    const Eigen::Index rows = Rows == Eigen::Dynamic ? needed : Rows;
    jacobian_.setZero(rows, this->columns_);
    error_.setZero(rows);
  }

  int solve(std::span<const glm::dvec3> targets_in_world,
            const glm::dvec3& com_in_world) override {
    this->found_ = this->reference_;
    T least = T(1e9);
    int stalled = 0;
    int step = 0;
    for (; step < kMaxSteps; ++step) {
      this->body_.forward(this->found_);
      const T worst = measure(targets_in_world, com_in_world);
      if (worst < T(kGoodEnough_m)) break;
      stalled = worst > least - T(1e-4) ? stalled + 1 : 0;
      if (stalled >= 3) break;
      least = std::min(least, worst);
      linearize();
      normal_.noalias() = jacobian_ * jacobian_.transpose();
      normal_.diagonal().array() += T(kDamping);
      factor_.compute(normal_);
      step_.noalias() = jacobian_.transpose() * factor_.solve(error_);
      this->body_.apply(step_, this->found_);
    }
    return step;
  }

 private:
  static constexpr int kMaxSteps = 50;
  static constexpr double kDamping = 1e-4;

  T weight(std::size_t k) const {
    return this->goals_[k].is_planted ? T(kPlantedWeight) : T(1);
  }

  /// Fills the errors. Returns the largest one, without limit or weight. [m]
  T measure(std::span<const glm::dvec3> targets, const glm::dvec3& com) {
    T worst = T(0);
    Eigen::Index row = 0;
    for (std::size_t k = 0; k < this->goals_.size(); ++k, row += 3) {
      const typename Base::Vec3 off =
          Base::Body::vec(targets[k]) - this->body_.place(this->goals_[k].joint);
      const T length = off.norm();
      worst = std::max(worst, length);
      error_.template segment<3>(row) =
          weight(k) * Base::shortened(off, length, T(kLongestPull_m));
    }
    if (!this->with_balance_) return worst;
    const typename Base::Vec3 off = Base::Body::vec(com) - this->body_.centre_of_mass();
    error_[row] = off[0];
    error_[row + 1] = off[2];
    return std::max(worst, std::hypot(off[0], off[2]));
  }

  void linearize() {
    Eigen::Index row = 0;
    for (std::size_t k = 0; k < this->goals_.size(); ++k, row += 3) {
      this->body_.point_rows(
          this->goals_[k].joint, weight(k), jacobian_.template middleRows<3>(row));
    }
    if (this->with_balance_) {
      this->body_.balance_rows(jacobian_.template middleRows<2>(row));
    }
  }

  Eigen::Matrix<T, Rows, Eigen::Dynamic> jacobian_;
  Eigen::Matrix<T, Rows, Rows> normal_;
  Eigen::Matrix<T, Rows, 1> error_;
  typename Base::Vector step_;
  Eigen::LLT<Eigen::Matrix<T, Rows, Rows>> factor_;
};

template <class T>
std::unique_ptr<GaussNewtonBaseline> make_dual(const Skeleton& skeleton,
                                               const std::vector<PointMass>& masses,
                                               std::span<const PointGoal> goals,
                                               bool with_balance) {
  if (goals.size() == 4 && with_balance) {
    return std::make_unique<DualSolver<T, 16>>(skeleton, masses, goals, true);
  }
  if (goals.size() == 4) {
    return std::make_unique<DualSolver<T, 12>>(skeleton, masses, goals, false);
  }
  return std::make_unique<DualSolver<T, Eigen::Dynamic>>(
      skeleton, masses, goals, with_balance);
}

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
    double least_m = 1e9;
    int stalled = 0;
    int step = 0;
    for (; step < kMaxSteps; ++step) {
      body_.forward(trial_);
      const double second_worst_m = measure(targets_in_world, com_in_world);
      // The residual of level 1 is added because stand_exactly() moves all points with
      // the root.
      const double worst_m = first_worst_m_ + second_worst_m;
      stalled = worst_m > least_m * 0.998 ? stalled + 1 : 0;
      if (worst_m < least_m || worst_m < kGoodEnough_m) {
        least_m = worst_m;
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
  static constexpr double kLongestLean_m = 0.2;

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
        second_error_.segment<3>(row[1]) = shortened(off, length, kLongestPull_m);
        row[1] += 3;
      }
    }
    if (with_balance_) {
      Vec3 off = Body::vec(com) - body_.centre_of_mass();
      off[1] = 0.0;
      const double length = off.norm();
      first_worst_m_ = std::max(first_worst_m_, length);
      off = shortened(off, length, kLongestLean_m);
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
