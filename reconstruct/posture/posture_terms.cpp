// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture_terms.h"

#include <cmath>
#include <limits>

namespace marey::reconstruct {
namespace {

/// Prior: the extremity of a limb is in line with its lower bone; both in the world, from
/// the limb's blocks.
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
                  PoseParameter parent,
                  PoseParameter child,
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
                 PoseParameter lower,
                 PoseParameter middle,
                 PoseParameter upper,
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
  const LimbParameters& s = kLimbParameters[limb];
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<ExtremityPrior, 3, 4, 1, 1, 4>(new ExtremityPrior{
          limb, lengths[index(s.upper)], lengths[index(s.lower)], sigma_rad}),
      nullptr,
      posture.block(s.frame),
      posture.block(s.flexion),
      posture.block(s.lower_twist),
      posture.block(s.extremity));
}

}  // namespace

std::vector<double*> blocks_of(Posture& posture, HumanBone bone) {
  std::vector<double*> blocks;
  for (const PoseParameter parameter : parameters_of(bone))
    blocks.push_back(posture.block(parameter));
  return blocks;
}

void add_posture_priors(Posture& posture,
                        const Lengths& lengths,
                        ceres::Problem& problem,
                        const TwistPriors& twists,
                        double collar_bone_factor,
                        double prior_share) {
  // A share of the weight is the inverse root of the share in the sigma.
  const double wider = 1.0 / std::sqrt(prior_share);
  for (const SpineBendPrior& row : kSpineBendPriors) {
    add_halfway(posture, row.lower, row.middle, row.upper, row.sigma_rad, problem);
  }
  for (const RelativePosePrior& row : kRelativePosePriors) {
    const glm::dquat usual = rotation_from_vector(row.usual_rad);
    glm::dvec3 sigma_rad = row.sigma_rad;
    if (row.child == PoseParameter::kLeftShoulder ||
        row.child == PoseParameter::kRightShoulder) {
      sigma_rad *= glm::dvec3(1.0, collar_bone_factor, collar_bone_factor);
    }
    if (!row.anatomy) sigma_rad *= wider;
    add_relative(posture, row.parent, row.child, usual, sigma_rad, problem);
  }
  for (std::size_t limb = 0; limb < kLimbParameters.size(); ++limb) {
    const LimbParameters& s = kLimbParameters[limb];
    const bool arm = limb < 2;
    add_extremity(posture, limb, lengths, wider * extremity_sigma_rad(limb), problem);
    const double upper_rad = arm ? twists.upper_arm : twists.leg;
    const double lower_rad = arm ? wider * twists.forearm : twists.leg;
    add_scalar(posture.block(s.upper_twist), 0.0, upper_rad, problem);
    add_scalar(posture.block(s.lower_twist), 0.0, lower_rad, problem);
    add_scalar(
        posture.block(s.flexion), kUsualFlexion_rad, wider * kFlexionSigma_rad, problem);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<FlexionLimit, 1, 1>(
                                 new FlexionLimit{kMinFlexion_rad, kMinFlexionSigma_rad}),
                             nullptr,
                             posture.block(s.flexion));
  }
}

void add_smoothness(Posture& before,
                    Posture& now,
                    Posture& after,
                    FrameRate rate,
                    ceres::Problem& problem) {
  for (const PoseParameter parameter : kAllPoseParameters) {
    const StepProcess process = process_of(parameter, rate);
    ceres::CostFunction* cost = nullptr;
    if (is_rotation(parameter)) {
      cost = new ceres::AutoDiffCostFunction<RotationAcceleration, 3, 4, 4, 4>(
          new RotationAcceleration{process.sigma, process.correlation});
    } else if (parameter == PoseParameter::kHipsPosition) {
      cost = new ceres::AutoDiffCostFunction<Acceleration<3>, 3, 3, 3, 3>(
          new Acceleration<3>{process.sigma, process.correlation});
    } else {
      cost = new ceres::AutoDiffCostFunction<Acceleration<1>, 1, 1, 1, 1>(
          new Acceleration<1>{process.sigma, process.correlation});
    }
    problem.AddResidualBlock(cost,
                             nullptr,
                             before.block(parameter),
                             now.block(parameter),
                             after.block(parameter));
  }
}

void add_first_speed(Posture& first,
                     Posture& second,
                     FrameRate rate,
                     ceres::Problem& problem) {
  for (const PoseParameter parameter : kAllPoseParameters) {
    const StepProcess process = process_of(parameter, rate);
    // Standard deviation of the stationary process x' = correlation x + noise.
    const double sigma =
        process.sigma / std::sqrt(1.0 - process.correlation * process.correlation);
    ceres::CostFunction* cost = nullptr;
    if (is_rotation(parameter)) {
      cost =
          new ceres::AutoDiffCostFunction<RotationStep, 3, 4, 4>(new RotationStep{sigma});
    } else if (parameter == PoseParameter::kHipsPosition) {
      cost = new ceres::AutoDiffCostFunction<Step<3>, 3, 3, 3>(new Step<3>{sigma});
    } else {
      cost = new ceres::AutoDiffCostFunction<Step<1>, 1, 1, 1>(new Step<1>{sigma});
    }
    problem.AddResidualBlock(
        cost, nullptr, first.block(parameter), second.block(parameter));
  }
}

void add_motion_prior(const Posture& expected,
                      double rad,
                      double metres,
                      Posture& posture,
                      ceres::Problem& problem) {
  for (const PoseParameter parameter : kAllPoseParameters) {
    ceres::CostFunction* cost = nullptr;
    if (is_rotation(parameter)) {
      cost = new ceres::AutoDiffCostFunction<RotationPrior, 3, 4>(
          new RotationPrior{expected.rotation(parameter), rad});
    } else if (parameter == PoseParameter::kHipsPosition) {
      const double* p = expected.block(parameter);
      cost = new ceres::AutoDiffCostFunction<PlacePrior, 3, 3>(
          new PlacePrior{{p[0], p[1], p[2]}, metres});
    } else {
      cost = new ceres::AutoDiffCostFunction<ScalarPrior, 1, 1>(
          new ScalarPrior{*expected.block(parameter), rad});
    }
    problem.AddResidualBlock(cost, nullptr, posture.block(parameter));
  }
}

void set_manifolds(Posture& posture, ceres::Problem& problem) {
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (is_rotation(parameter) && problem.HasParameterBlock(posture.block(parameter))) {
      problem.SetManifold(posture.block(parameter), new ceres::EigenQuaternionManifold);
    }
  }
}

void set_posture_constant(Posture& posture, ceres::Problem& problem) {
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (problem.HasParameterBlock(posture.block(parameter))) {
      problem.SetParameterBlockConstant(posture.block(parameter));
    }
  }
}

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // SuiteSparse calls the machine's BLAS, whose order of summation may depend on memory
  // alignment.
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
