// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The solvers of gauss_newton_baseline.h. Each number type is compiled in a file of its
// own: Eigen's products take half a minute per type.

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "benchmarks/baseline/gauss_newton_baseline.h"
#include "benchmarks/markers/ball_joint_body.h"

namespace marey::gauss_newton {

inline constexpr double kGoodEnough_m = 1e-3;
inline constexpr double kMaxPull_m = 0.3;  // Limit of a point's error in one step.
inline constexpr double kPlantedWeight = 5.0;

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
    T minimum = T(1e9);
    int stalled = 0;
    int step = 0;
    for (; step < kMaxSteps; ++step) {
      this->body_.forward(this->found_);
      const T worst = measure(targets_in_world, com_in_world);
      if (worst < T(kGoodEnough_m)) break;
      stalled = worst > minimum - T(1e-4) ? stalled + 1 : 0;
      if (stalled >= 3) break;
      minimum = std::min(minimum, worst);
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
  static inline constexpr double kDamping = 1e-4;

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
          weight(k) * Base::shortened(off, length, T(kMaxPull_m));
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

extern template std::unique_ptr<GaussNewtonBaseline> make_dual<float>(
    const Skeleton&, const std::vector<PointMass>&, std::span<const PointGoal>, bool);
extern template std::unique_ptr<GaussNewtonBaseline> make_dual<double>(
    const Skeleton&, const std::vector<PointMass>&, std::span<const PointGoal>, bool);

}  // namespace marey::gauss_newton
