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

struct SlotAcceleration {
  Slot slot;
  double sigma;  ///< [m/s^2] or [rad/s^2], at 30 frames per second.
};

// What quick everyday movement reaches (a jump's landing is a few times more, for a frame
// or two, which the measurements then carry).
constexpr std::array<SlotAcceleration, kSlotCount> kAccelerations{{
    {Slot::kHipsPosition, 10.0},
    {Slot::kHips, 30.0},
    {Slot::kAbdomenEnd, 30.0},
    {Slot::kThorax, 30.0},
    {Slot::kNeck, 40.0},
    {Slot::kHead, 50.0},
    {Slot::kLeftShoulder, 30.0},
    {Slot::kRightShoulder, 30.0},
    {Slot::kLeftArm, 70.0},
    {Slot::kRightArm, 70.0},
    {Slot::kLeftLeg, 60.0},
    {Slot::kRightLeg, 60.0},
    {Slot::kLeftHand, 110.0},
    {Slot::kRightHand, 110.0},
    {Slot::kLeftFoot, 90.0},
    {Slot::kRightFoot, 90.0},
    {Slot::kLeftElbow, 80.0},
    {Slot::kRightElbow, 80.0},
    {Slot::kLeftKnee, 80.0},
    {Slot::kRightKnee, 80.0},
    {Slot::kLeftForearmTwist, 60.0},
    {Slot::kRightForearmTwist, 60.0},
    {Slot::kLeftShankTwist, 30.0},
    {Slot::kRightShankTwist, 30.0},
    {Slot::kLeftUpperArmTwist, 40.0},
    {Slot::kRightUpperArmTwist, 40.0},
    {Slot::kLeftThighTwist, 30.0},
    {Slot::kRightThighTwist, 30.0},
}};

struct Process {
  double sigma;  ///< Of the change of a step from one frame to the next.
  double keeps;  ///< Share of a step that the next one inherits.
};

Process process_of(const SlotAcceleration& row, FrameRate rate) {
  const double dt = 1.0 / rate.hz;
  const double memory_s = row.slot == Slot::kHipsPosition ? 1.0 : 0.25;
  // Variance of a second difference of integrated white noise grows with the cube of dt.
  return {row.sigma * std::sqrt(dt * dt * dt / 30.0), std::exp(-dt / memory_s)};
}

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

TagImage tag_image(const Camera& camera, const TagDetection& tag) {
  return {camera.intrinsics, camera.camera_from_world, tag.corners_px, tag.sigma_px};
}

std::vector<double*> blocks_of(Posture& posture, HumanBone bone) {
  std::vector<double*> blocks;
  for (const Slot slot : slots_of(bone)) blocks.push_back(posture.block(slot));
  return blocks;
}

void add_habits(Posture& posture,
                const Lengths& lengths,
                ceres::Problem& problem,
                double arm_twist_rad) {
  const glm::dquat none(1, 0, 0, 0);
  add_halfway(posture, Slot::kHips, Slot::kAbdomenEnd, Slot::kThorax, 0.12, problem);
  add_halfway(posture, Slot::kThorax, Slot::kNeck, Slot::kHead, 0.15, problem);
  add_relative(posture, Slot::kHips, Slot::kThorax, none, glm::dvec3(0.7), problem);
  add_relative(posture, Slot::kThorax, Slot::kHead, none, glm::dvec3(0.7), problem);
  for (const Slot shoulder : {Slot::kLeftShoulder, Slot::kRightShoulder}) {
    // About its own axis nothing moves but skin.
    add_relative(
        posture, Slot::kThorax, shoulder, none, glm::dvec3(0.1, 0.25, 0.25), problem);
  }
  const auto hanging = [](double side) {
    return rotation_from_vector({0.0, 0.0, -side * glm::radians(70.0)});
  };
  const glm::dvec3 anywhere(1.0);
  add_relative(posture, Slot::kThorax, Slot::kLeftArm, hanging(1), anywhere, problem);
  add_relative(posture, Slot::kThorax, Slot::kRightArm, hanging(-1), anywhere, problem);
  add_relative(posture, Slot::kHips, Slot::kLeftLeg, none, glm::dvec3(0.8), problem);
  add_relative(posture, Slot::kHips, Slot::kRightLeg, none, glm::dvec3(0.8), problem);
  for (std::size_t limb = 0; limb < kLimbSlots.size(); ++limb) {
    const LimbSlots& s = kLimbSlots[limb];
    const bool arm = limb < 2;
    add_extremity(posture, limb, lengths, arm ? 0.5 : 0.35, problem);
    add_scalar(posture.block(s.upper_twist), 0.0, arm ? arm_twist_rad : 0.08, problem);
    add_scalar(posture.block(s.lower_twist), 0.0, arm ? arm_twist_rad : 0.08, problem);
    add_scalar(posture.block(s.flexion), 0.3, 1.0, problem);
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<FlexionLimit, 1, 1>(new FlexionLimit{-0.05, 0.1}),
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
    const Process process = process_of(row, rate);
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
    const Process process = process_of(row, rate);
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
