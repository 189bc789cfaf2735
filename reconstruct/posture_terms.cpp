// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture_terms.h"

#include <cmath>
#include <limits>

namespace marey::reconstruct {
namespace {

/// The far bone of a limb in the world, from the limb's blocks.
struct ExtremityPrior {
  std::size_t limb;
  double upper_m;
  double lower_m;
  double sigma_rad;

  template <class T>
  bool operator()(const T* frame,
                  const T* flexion,
                  const T* twist,
                  const T* extremity,
                  T* residual) const {
    using Q = Eigen::Quaternion<T>;
    using std::atan2;
    using std::cos;
    using std::sin;
    const T alpha = atan2(lower_m * sin(flexion[0]), upper_m + lower_m * cos(flexion[0]));
    const Q lower =
        Q(Eigen::Map<const Q>(frame)) *
        detail::about_axis(human_limbs()[limb].hinge_axis, T(flexion[0] - alpha)) *
        detail::about_axis(limb_axis(limb), twist[0]);
    const auto off =
        log_rotation<T>(lower.conjugate() * Q(Eigen::Map<const Q>(extremity)));
    for (int i = 0; i < 3; ++i) residual[i] = off[i] / T(sigma_rad);
    return true;
  }
};

void add_relative(Posture& posture,
                  Slot parent,
                  Slot child,
                  const glm::dquat& parent_from_child,
                  const glm::dvec3& sigma_rad,
                  ceres::Problem& problem) {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<RelativeRotationPrior, 3, 4, 4>(
          new RelativeRotationPrior{parent_from_child, sigma_rad}),
      nullptr,
      posture.block(parent),
      posture.block(child));
}

void add_halfway(Posture& posture,
                 Slot lower,
                 Slot middle,
                 Slot upper,
                 double sigma_rad,
                 ceres::Problem& problem) {
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<HalfwayPrior, 3, 4, 4, 4>(
                               new HalfwayPrior{sigma_rad}),
                           nullptr,
                           posture.block(lower),
                           posture.block(middle),
                           posture.block(upper));
}

void add_scalar(double* block, double expected, double sigma, ceres::Problem& problem) {
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ScalarPrior, 1, 1>(
                               new ScalarPrior{expected, sigma}),
                           nullptr,
                           block);
}

void add_extremity(Posture& posture,
                   std::size_t limb,
                   const Lengths& lengths,
                   double sigma_rad,
                   ceres::Problem& problem) {
  const LimbSlots& s = kLimbSlots[limb];
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<ExtremityPrior, 3, 4, 1, 1, 4>(new ExtremityPrior{
          limb, lengths[index(s.upper)], lengths[index(s.lower)], sigma_rad}),
      nullptr,
      posture.block(s.frame),
      posture.block(s.flexion),
      posture.block(s.lower_twist),
      posture.block(s.extremity));
}

void add_upright(double* rotation, double sigma_rad, bool roll, ceres::Problem& problem) {
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<UprightPrior, 2, 4>(
                               new UprightPrior{sigma_rad, roll}),
                           nullptr,
                           rotation);
}

}  // namespace

std::vector<double*> blocks_of(Posture& posture, HumanBone bone) {
  std::vector<double*> blocks;
  for (const Slot slot : slots_of(bone)) blocks.push_back(posture.block(slot));
  return blocks;
}

void add_habits(Posture& posture,
                const Lengths& lengths,
                ceres::Problem& problem,
                const TwistHabits& twists,
                double shoulders_wider,
                double habit_share) {
  // A weight's share is a sigma's inverse root.
  const double wider = 1.0 / std::sqrt(habit_share);
  for (const HalfwayHabit& row : kHalfwayHabits) {
    add_halfway(posture, row.lower, row.middle, row.upper, row.sigma_rad, problem);
  }
  for (const RelativeHabit& row : kRelativeHabits) {
    const glm::dquat usual = rotation_from_vector(row.usual_rad);
    glm::dvec3 sigma_rad = row.sigma_rad;
    if (row.child == Slot::kLeftShoulder || row.child == Slot::kRightShoulder) {
      sigma_rad *= glm::dvec3(1.0, shoulders_wider, shoulders_wider);
    }
    if (!row.anatomy) sigma_rad *= wider;
    add_relative(posture, row.parent, row.child, usual, sigma_rad, problem);
  }
  for (std::size_t limb = 0; limb < kLimbSlots.size(); ++limb) {
    const LimbSlots& s = kLimbSlots[limb];
    const bool arm = limb < 2;
    add_extremity(posture, limb, lengths, wider * extremity_sigma_rad(limb), problem);
    const double upper_rad = arm ? twists.upper_arm : twists.leg;
    const double lower_rad = arm ? wider * twists.forearm : twists.leg;
    add_scalar(posture.block(s.upper_twist), 0.0, upper_rad, problem);
    add_scalar(posture.block(s.lower_twist), 0.0, lower_rad, problem);
    add_scalar(
        posture.block(s.flexion), kUsualFlexion_rad, wider * kFlexionSigma_rad, problem);
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<FlexionLimit, 1, 1>(
            new FlexionLimit{kLeastFlexion_rad, kLeastFlexionSigma_rad}),
        nullptr,
        posture.block(s.flexion));
  }
}

void add_standing(Posture& posture, const Lengths& lengths, ceres::Problem& problem) {
  const glm::dquat none(1, 0, 0, 0);
  // The hips' roll is not habit but measured: their X axis runs through both hip centres.
  add_upright(posture.block(Slot::kHips), 0.03, false, problem);
  add_upright(posture.block(Slot::kThorax), 0.03, true, problem);
  add_upright(posture.block(Slot::kHead), 0.03, true, problem);
  add_upright(posture.block(Slot::kLeftFoot), 0.02, true, problem);
  add_upright(posture.block(Slot::kRightFoot), 0.02, true, problem);
  add_halfway(posture, Slot::kHips, Slot::kAbdomenEnd, Slot::kThorax, 0.03, problem);
  add_relative(posture, Slot::kThorax, Slot::kHead, none, glm::dvec3(0.1), problem);
  for (const Slot shoulder : {Slot::kLeftShoulder, Slot::kRightShoulder}) {
    add_relative(posture, Slot::kThorax, shoulder, none, glm::dvec3(0.1), problem);
  }
  for (std::size_t limb = 0; limb < kLimbSlots.size(); ++limb) {
    add_extremity(posture, limb, lengths, limb < 2 ? 0.1 : 0.15, problem);
    add_scalar(posture.block(kLimbSlots[limb].upper_twist), 0.0, 0.02, problem);
    add_scalar(posture.block(kLimbSlots[limb].lower_twist), 0.0, 0.02, problem);
  }
}

void add_smoothness(Posture& before,
                    Posture& now,
                    Posture& after,
                    FrameRate rate,
                    ceres::Problem& problem) {
  for (const SlotAcceleration& row : kAccelerations) {
    const StepProcess process = process_of(row, rate);
    ceres::CostFunction* cost = nullptr;
    if (is_rotation(row.slot)) {
      cost = new ceres::AutoDiffCostFunction<RotationAcceleration, 3, 4, 4, 4>(
          new RotationAcceleration{process.sigma, process.keeps});
    } else if (row.slot == Slot::kHipsPosition) {
      cost = new ceres::AutoDiffCostFunction<Acceleration<3>, 3, 3, 3, 3>(
          new Acceleration<3>{process.sigma, process.keeps});
    } else {
      cost = new ceres::AutoDiffCostFunction<Acceleration<1>, 1, 1, 1, 1>(
          new Acceleration<1>{process.sigma, process.keeps});
    }
    problem.AddResidualBlock(cost,
                             nullptr,
                             before.block(row.slot),
                             now.block(row.slot),
                             after.block(row.slot));
  }
}

void add_first_speed(Posture& first,
                     Posture& second,
                     FrameRate rate,
                     ceres::Problem& problem) {
  for (const SlotAcceleration& row : kAccelerations) {
    const StepProcess process = process_of(row, rate);
    // The stationary spread of x' = keeps x + noise.
    const double sigma = process.sigma / std::sqrt(1.0 - process.keeps * process.keeps);
    ceres::CostFunction* cost = nullptr;
    if (is_rotation(row.slot)) {
      cost =
          new ceres::AutoDiffCostFunction<RotationStep, 3, 4, 4>(new RotationStep{sigma});
    } else if (row.slot == Slot::kHipsPosition) {
      cost = new ceres::AutoDiffCostFunction<Step<3>, 3, 3, 3>(new Step<3>{sigma});
    } else {
      cost = new ceres::AutoDiffCostFunction<Step<1>, 1, 1, 1>(new Step<1>{sigma});
    }
    problem.AddResidualBlock(
        cost, nullptr, first.block(row.slot), second.block(row.slot));
  }
}

void add_leash(const Posture& expected,
               double rad,
               double metres,
               Posture& posture,
               ceres::Problem& problem) {
  for (const Slot slot : kAllSlots) {
    ceres::CostFunction* cost = nullptr;
    if (is_rotation(slot)) {
      cost = new ceres::AutoDiffCostFunction<RotationPrior, 3, 4>(
          new RotationPrior{expected.rotation(slot), rad});
    } else if (slot == Slot::kHipsPosition) {
      const double* p = expected.block(slot);
      cost = new ceres::AutoDiffCostFunction<PlacePrior, 3, 3>(
          new PlacePrior{{p[0], p[1], p[2]}, metres});
    } else {
      cost = new ceres::AutoDiffCostFunction<ScalarPrior, 1, 1>(
          new ScalarPrior{*expected.block(slot), rad});
    }
    problem.AddResidualBlock(cost, nullptr, posture.block(slot));
  }
}

void set_manifolds(Posture& posture, ceres::Problem& problem) {
  for (const Slot slot : kAllSlots) {
    if (is_rotation(slot) && problem.HasParameterBlock(posture.block(slot))) {
      problem.SetManifold(posture.block(slot), new ceres::EigenQuaternionManifold);
    }
  }
}

void hold(Posture& posture, ceres::Problem& problem) {
  for (const Slot slot : kAllSlots) {
    if (problem.HasParameterBlock(posture.block(slot))) {
      problem.SetParameterBlockConstant(posture.block(slot));
    }
  }
}

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // SuiteSparse calls whatever BLAS the machine has, whose order of summation may follow
  // where memory lies.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-6;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

double cost_of(const ceres::Solver::Summary& summary) {
  return summary.IsSolutionUsable() ? summary.final_cost
                                    : std::numeric_limits<double>::infinity();
}

}  // namespace marey::reconstruct
