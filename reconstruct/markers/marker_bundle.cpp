// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_bundle.h"

#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Dense>

#include "core/base/assert.h"
#include "reconstruct/markers/marker_loss.h"
#include "reconstruct/posture/length_terms.h"
#include "reconstruct/posture/normal_matrix.h"
#include "reconstruct/posture/posture_terms.h"

namespace marey::reconstruct {
namespace {

/// A marker of a body that is being measured. Blocks: its bone's parameters, the lengths,
/// and its place on the bone.
struct MarkerResidual {
  HumanBone bone;
  std::vector<PoseParameter> parameters;
  BodyConstants body;
  Eigen::Vector3d p_in_world;
  double sigma_m;

  template <class T>
  bool operator()(const T* const* list, T* residual) const {
    const PostureBlocks<T> blocks(parameters, list, 2);
    const BoneFrame<T> frame =
        bone_frame<T, T>(bone,
                         std::span<const T* const, kPoseParameterCount>(blocks.of),
                         blocks.extra[0],
                         body);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> place(blocks.extra[1]);
    const Eigen::Matrix<T, 3, 1> p = frame.rotation * place + frame.origin;
    for (int i = 0; i < 3; ++i) residual[i] = (p[i] - p_in_world[i]) / sigma_m;
    return true;
  }
};

/// Prior of a marker's place.
struct PlaceResidual {
  MarkerPlacePrior estimate;

  template <class T>
  bool operator()(const T* place, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      residual[i] = (place[i] - estimate.p_in_bone[i]) / estimate.sigma_m;
    }
    return true;
  }
};

void add_markers(MarkerBundle& bundle, MarkerInstant& instant, ceres::Problem& problem) {
  for (const SeenMarker& seen : instant.seen) {
    ModelMarker& marker = bundle.model.markers[seen.marker];
    auto residual = std::make_unique<MarkerResidual>(
        MarkerResidual{marker.bone,
                       parameters_of(marker.bone),
                       bundle.model.body,
                       seen.p_in_world,
                       std::hypot(marker.sigma_m, seen.sigma_m, kSkinBias_m)});
    std::vector<double*> blocks = blocks_of(instant.posture, marker.bone);
    blocks.push_back(bundle.model.lengths.data());
    blocks.push_back(marker.p_in_bone.data());
    problem.AddResidualBlock(bone_cost<3, kLengthCount, 3>(std::move(residual)),
                             new ceres::CauchyLoss(kMarkerLossSigmas),
                             blocks);
  }
}

/// Computes the covariance of the lengths and places. Instants share only these, so they
/// are eliminated one by one (Schur complement).
std::optional<Eigen::MatrixXd> subject_covariance(MarkerBundle& bundle,
                                                  ceres::Problem& problem) {
  std::vector<double*> blocks;
  std::vector<int> sizes;
  for (MarkerInstant& instant : bundle.instants) {
    int size = 0;
    for (const PoseParameter parameter : kAllPoseParameters) {
      if (!problem.HasParameterBlock(instant.posture.block(parameter))) continue;
      blocks.push_back(instant.posture.block(parameter));
      size += tangent_size(parameter);
    }
    sizes.push_back(size);
  }
  blocks.push_back(bundle.model.lengths.data());
  for (ModelMarker& marker : bundle.model.markers) {
    blocks.push_back(marker.p_in_bone.data());
  }
  const int shared = kLengthCount + 3 * static_cast<int>(bundle.model.markers.size());
  const auto normal = normal_matrix(problem, std::move(blocks));
  if (!normal) return std::nullopt;
  const int first_shared = static_cast<int>(normal->cols()) - shared;
  Eigen::MatrixXd information = normal->block(first_shared, first_shared, shared, shared);
  int start = 0;
  for (const int size : sizes) {
    Eigen::MatrixXd own = normal->block(start, start, size, size);
    own.diagonal().array() += 1e-9;
    const Eigen::MatrixXd cross = normal->block(start, first_shared, size, shared);
    information -= cross.transpose() * own.ldlt().solve(cross);
    start += size;
  }
  information.diagonal().array() += 1e-9;
  const Eigen::LDLT<Eigen::MatrixXd> factor(information);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
  Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(shared, shared));
  // A covariance that is not finite or not positive is invalid.
  if (!covariance.allFinite() || covariance.diagonal().minCoeff() <= 0.0) {
    return std::nullopt;
  }
  return covariance;
}

bool fill_sigmas(MarkerBundle& bundle, ceres::Problem& problem) {
  const auto covariance = subject_covariance(bundle, problem);
  if (!covariance) return false;
  const auto variance = [&](int i) { return (*covariance)(i, i); };
  for (int i = 0; i < kLengthCount; ++i) {
    bundle.length_sigma_m[static_cast<std::size_t>(i)] = std::sqrt(variance(i));
  }
  bundle.place_sigma_m.clear();
  for (std::size_t m = 0; m < bundle.model.markers.size(); ++m) {
    const int at = kLengthCount + 3 * static_cast<int>(m);
    bundle.place_sigma_m.push_back(
        std::sqrt((variance(at) + variance(at + 1) + variance(at + 2)) / 3.0));
  }
  return true;
}

}  // namespace

bool adjust(MarkerBundle& bundle, int max_iterations, bool sigmas) {
  MAREY_ASSERT(bundle.places.size() == bundle.model.markers.size());
  ceres::Problem problem;
  for (MarkerInstant& instant : bundle.instants) {
    add_markers(bundle, instant, problem);
    add_posture_priors(instant.posture,
                       bundle.model.lengths,
                       problem,
                       bundle.model.twists,
                       1.0,
                       1.0 / static_cast<double>(bundle.instants.size()));
    set_manifolds(instant.posture, problem);
  }
  add_length_priors(bundle.usual, bundle.usual_sigma_m, bundle.model.lengths, problem);
  for (std::size_t m = 0; m < bundle.places.size(); ++m) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaceResidual, 3, 3>(
                                 new PlaceResidual{bundle.places[m]}),
                             nullptr,
                             bundle.model.markers[m].p_in_bone.data());
  }
  ceres::Solver::Summary summary;
  ceres::Solver::Options options = solver_options(max_iterations);
  options.function_tolerance = 1e-4;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  return !sigmas || fill_sigmas(bundle, problem);
}

}  // namespace marey::reconstruct
