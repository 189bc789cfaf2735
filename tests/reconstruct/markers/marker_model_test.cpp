// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_model.h"

#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/markers/marker_loss.h"
#include "reconstruct/posture/posture_terms.h"
#include "tests/reconstruct/random_posture.h"

namespace marey::reconstruct {
namespace {

using Eigen::Vector3d;
using marey::testing::Dice;

struct Scene {
  MarkerModel model;
  Posture truth;
  std::vector<SeenMarker> seen;
};

Posture near(const Posture& posture, double by, unsigned seed) {
  Dice dice(seed);
  PostureVector step;
  for (int i = 0; i < kPostureFreedom; ++i) step[i] = dice.between(-by, by);
  Posture moved = posture;
  move(moved, step);
  return moved;
}

/// Returns three markers on every bone except toes, with noise `noise_m` per coordinate.
Scene random_scene(unsigned seed, double noise_m) {
  Dice dice(seed);
  Scene scene;
  scene.model.lengths = random_lengths(dice);
  scene.model.body = average_frame();
  // No foot is turned backward: pose priors this far off change the minimum.
  scene.truth = near(Posture{}, 0.5, seed + 1000);
  UnfoldedPosture unfolded;
  unfolded.unfold(scene.truth, scene.model.lengths, scene.model.body);
  for (const HumanBone bone : human_bones()) {
    if (bone == HumanBone::kLeftToes || bone == HumanBone::kRightToes) continue;
    for (int i = 0; i < 3; ++i) {
      const Vector3d p(
          dice.between(-0.1, 0.1), dice.between(-0.1, 0.1), dice.between(-0.1, 0.1));
      const Vector3d noise(dice.between(-noise_m, noise_m),
                           dice.between(-noise_m, noise_m),
                           dice.between(-noise_m, noise_m));
      scene.seen.push_back(
          {scene.model.markers.size(), unfolded.point(bone, p) + noise, 0.0});
      scene.model.markers.push_back({bone, p, 0.002});
    }
  }
  return scene;
}

/// The residual of one marker for Ceres, with automatic derivatives: the reference for
/// the solver with analytic derivatives.
struct MarkerResidual {
  HumanBone bone;
  std::vector<PoseParameter> parameters;
  const MarkerModel* model;
  Vector3d p_in_bone;
  Vector3d p_in_world;
  double sigma_m;

  template <class T>
  bool operator()(T const* const* blocks, T* residual) const {
    std::array<const T*, kPoseParameterCount> by_slot{};
    for (std::size_t i = 0; i < parameters.size(); ++i)
      by_slot[index(parameters[i])] = blocks[i];
    const BoneFrame<T> frame =
        bone_frame<T, double>(bone,
                              std::span<const T* const, kPoseParameterCount>(by_slot),
                              model->lengths.data(),
                              model->body);
    const Eigen::Matrix<T, 3, 1> p = frame.rotation * p_in_bone.cast<T>() + frame.origin;
    for (int i = 0; i < 3; ++i) residual[i] = (p[i] - p_in_world[i]) / sigma_m;
    return true;
  }
};

Posture solved_by_ceres(const Scene& scene, Posture posture) {
  ceres::Problem problem;
  for (const SeenMarker& seen : scene.seen) {
    const ModelMarker& marker = scene.model.markers[seen.marker];
    auto* cost = new ceres::DynamicAutoDiffCostFunction<MarkerResidual>(
        new MarkerResidual{marker.bone,
                           parameters_of(marker.bone),
                           &scene.model,
                           marker.p_in_bone,
                           seen.p_in_world,
                           marker.sigma_m});
    for (const PoseParameter parameter : parameters_of(marker.bone)) {
      cost->AddParameterBlock(block_size(parameter));
    }
    cost->SetNumResiduals(3);
    problem.AddResidualBlock(
        cost, new ceres::CauchyLoss(kMarkerLossSigmas), blocks_of(posture, marker.bone));
  }
  add_posture_priors(posture, scene.model.lengths, problem, scene.model.twists);
  set_manifolds(posture, problem);
  ceres::Solver::Options options = solver_options(100);
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return posture;
}

double apart(const Posture& a, const Posture& b) {
  return step_between(a, b).cwiseAbs().maxCoeff();
}

TEST(MarkerFrameSolver, FindsTheLeastCostThatCeresFinds) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Scene scene = random_scene(seed, 0.004);
    scene.seen[7].p_in_world.x() += 0.1;  // A wrong one.
    const Posture start = near(scene.truth, 0.2, seed + 100);
    Posture posture = start;
    MarkerFrameSolver solver(scene.model);
    (void)solver.solve(scene.seen, nullptr, posture, {100, 1e-9});
    // Tolerances of both solvers.
    EXPECT_LT(apart(posture, solved_by_ceres(scene, start)), 1e-5);
  }
}

TEST(MarkerFrameSolver, StopsAtOnceWhereItIsNearTheLeastCost) {
  const Scene scene = random_scene(6, 0.001);
  MarkerFrameSolver solver(scene.model);
  Posture posture = near(scene.truth, 0.2, 106);
  (void)solver.solve(scene.seen, nullptr, posture, {100, 1e-9});
  Posture again = near(posture, 0.02, 107);
  (void)solver.solve(scene.seen, nullptr, again);
  EXPECT_LE(solver.iterations(), 6);
  // The planes of straight limbs are nearly free, and their last steps are the least
  // exact.
  EXPECT_LT(apart(again, posture), 1e-3);
}

TEST(MarkerFrameSolver, KeepsToThePriorWhereNothingIsSeen) {
  Scene scene = random_scene(7, 0.0);
  // No marker of the left arm, from the shoulder on.
  std::erase_if(scene.seen, [&](const SeenMarker& seen) {
    const HumanBone bone = scene.model.markers[seen.marker].bone;
    return bone == HumanBone::kLeftUpperArm || bone == HumanBone::kLeftLowerArm ||
           bone == HumanBone::kLeftHand;
  });
  PosturePrior prior;
  prior.expected = scene.truth;
  for (auto& information : prior.information) {
    information = 1e4 * Eigen::Matrix3d::Identity();
  }
  MarkerFrameSolver solver(scene.model);
  Posture posture = near(scene.truth, 0.1, 108);
  (void)solver.solve(scene.seen, &prior, posture, {100, 1e-9});
  // Pose priors have a weight of some 10 against the prior's 10,000, from half a turn
  // away.
  EXPECT_LT(apart(posture, scene.truth), 0.01);
}

TEST(ArrowFactor, GivesTheInverseOfItsEquations) {
  const Scene scene = random_scene(8, 0.001);
  UnfoldedPosture unfolded;
  unfolded.unfold(scene.truth, scene.model.lengths, scene.model.body);
  PostureEquations equations;
  equations.clear();
  SparseDerivative d;
  for (const ModelMarker& marker : scene.model.markers) {
    unfolded.derivative(marker.bone, unfolded.point(marker.bone, marker.p_in_bone), d);
    equations.add(d, Vector3d(1e-3, 2e-3, -1e-3), 1e4);
  }
  equations.add_posture_priors(scene.truth, unfolded, scene.model.twists);
  ArrowFactor factor;
  ASSERT_TRUE(factor.factor(equations.hessian, 0.0));
  const PostureMatrix full = equations.hessian.selfadjointView<Eigen::Lower>();
  const PostureMatrix inverse = full.inverse();
  PostureVector step;
  factor.step(equations.gradient, step);
  EXPECT_LT((step + inverse * equations.gradient).norm(), 1e-9 * step.norm());
  PostureCovariance covariance;
  factor.covariance(covariance);
  unfolded.derivative(HumanBone::kLeftHand, unfolded.origin(HumanBone::kLeftHand), d);
  Eigen::Matrix<double, 3, kPostureFreedom> dense;
  dense.setZero();
  for (int i = 0; i < d.columns; ++i) {
    dense.col(d.column[static_cast<std::size_t>(i)]) = d.value.col(i);
  }
  const Eigen::Matrix3d expected = dense * inverse * dense.transpose();
  EXPECT_LT((covariance.of(d) - expected).norm(), 1e-9 * expected.norm());
}

}  // namespace
}  // namespace marey::reconstruct
