// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/plan_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "calib/model/project_point.h"
#include "calib/plan/tag_visibility.h"
#include "core/base/assert.h"
#include "core/base/cross_matrix.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

constexpr int kPoseOfCamera = static_cast<int>(RigCovariance::kPerCamera);
using Corners = TagCorners;

struct View {
  CameraId camera{};
  double side_px = 0.0;
};

/// Returns the covariance of a tag's pose: rotation vector in the world [rad], then
/// centre [m]; nullopt in the cases of point_covariance().
std::optional<Eigen::Matrix<double, 6, 6>> pose_covariance(
    std::span<const Camera> cameras,
    const RigCovariance* covariance,
    const glm::dvec3& centre,
    const Corners& corners,
    std::span<const View> views,
    const CornerSigma& corner_sigma) {
  const auto count = static_cast<Eigen::Index>(views.size());
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(6, kPoseOfCamera * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const View& view = views[static_cast<std::size_t>(i)];
    const double sigma_px = corner_sigma(view.side_px);
    MAREY_ASSERT(sigma_px > 0.0);
    const double weight = 1.0 / (sigma_px * sigma_px);
    for (const glm::dvec3& corner : corners) {
      const auto sight = project_point(cameras[index(view.camera)], corner);
      if (!sight) return std::nullopt;
      Eigen::Matrix<double, 2, 6> by_pose;
      by_pose << -sight->by_point *
                     cross_matrix<Eigen::Matrix3d>(to_eigen(corner - centre)),
          sight->by_point;
      information += weight * by_pose.transpose() * by_pose;
      pull.middleCols<kPoseOfCamera>(kPoseOfCamera * i) +=
          weight * by_pose.transpose() * sight->by_camera;
    }
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(information);
  const Eigen::Matrix<double, 6, 1> pivots = factor.vectorD();
  // Metres and radians differ by the tag's size; see point_covariance().
  if (!(pivots.minCoeff() > 1e-16 * pivots.maxCoeff())) return std::nullopt;
  Eigen::Matrix<double, 6, 6> out = factor.solve(Eigen::Matrix<double, 6, 6>::Identity());
  if (!covariance) return out;
  const Eigen::MatrixXd gain = factor.solve(pull);
  Eigen::MatrixXd uncertainty(gain.cols(), gain.cols());
  const auto place = [&](Eigen::Index k) {
    const View& view = views[static_cast<std::size_t>(k / kPoseOfCamera)];
    return RigCovariance::kPerCamera * index(view.camera) +
           static_cast<std::size_t>(k % kPoseOfCamera);
  };
  for (Eigen::Index row = 0; row < uncertainty.rows(); ++row) {
    for (Eigen::Index column = 0; column < uncertainty.cols(); ++column) {
      uncertainty(row, column) = covariance->at(place(row), place(column));
    }
  }
  return out + gain * uncertainty * gain.transpose();
}

/// Returns an upright tag that faces the horizontal direction `angle_rad`: 0 is +Z,
/// positive towards +X.
RigidTransform upright_tag(const glm::dvec3& p_in_world, double angle_rad) {
  const glm::dvec3 into_tag{-std::sin(angle_rad), 0.0, -std::cos(angle_rad)};
  const glm::dvec3 down{0.0, -1.0, 0.0};
  return {glm::quat_cast(glm::dmat3(glm::cross(down, into_tag), down, into_tag)),
          p_in_world};
}

std::optional<MedianAndP95> spread(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return MedianAndP95{median(values), quantile(values, 0.95)};
}

/// Sums over the tags of one position or one height.
struct Tally {
  int tags = 0;
  std::vector<double> sides_px;
  std::vector<double> centre_m;
  std::vector<double> joint_m;

  void add(const ExpectedTag& tag) {
    ++tags;
    if (!tag.seen_by.empty()) sides_px.push_back(tag.side_px);
    if (tag.centre_error_m) centre_m.push_back(*tag.centre_error_m);
    if (tag.joint_error_m) joint_m.push_back(*tag.joint_error_m);
  }
  [[nodiscard]] double share(const std::vector<double>& of) const {
    return static_cast<double>(of.size()) / std::max(1, tags);
  }
};

std::optional<double> root_mean_square(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

PlannedPlace place_of(const glm::dvec3& p_in_world, const Tally& tally) {
  PlannedPlace out;
  out.p_in_world = p_in_world;
  out.seen_share = tally.share(tally.sides_px);
  out.measured_share = tally.share(tally.centre_m);
  for (const double side : tally.sides_px) {
    out.side_px += side / static_cast<double>(tally.sides_px.size());
  }
  out.centre_error_m = root_mean_square(tally.centre_m);
  out.joint_error_m = root_mean_square(tally.joint_m);
  return out;
}

PlannedHeight height_of(double height_m, const Tally& tally) {
  PlannedHeight out;
  out.height_m = height_m;
  out.seen_share = tally.share(tally.sides_px);
  out.measured_share = tally.share(tally.centre_m);
  if (!tally.sides_px.empty()) out.side_px = median(tally.sides_px);
  out.centre_error_m = spread(tally.centre_m);
  out.joint_error_m = spread(tally.joint_m);
  return out;
}

}  // namespace

ExpectedTag expect_tag(std::span<const Camera> cameras,
                       const RigCovariance* covariance,
                       const RigidTransform& world_from_tag,
                       const CornerSigma& corner_sigma,
                       const PlanOptions& options) {
  MAREY_ASSERT(options.tag_size_m > 0.0);
  MAREY_ASSERT(!covariance || covariance->cameras == cameras.size());
  const Corners corners = corners_in_world(world_from_tag, options.tag_size_m);
  ExpectedTag out;
  std::vector<View> views;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const auto side_px = visible_side_px(cameras[c], world_from_tag, corners, options);
    if (!side_px) continue;
    views.push_back({CameraId{static_cast<int>(c)}, *side_px});
    out.seen_by.push_back(views.back().camera);
    out.side_px += *side_px;
  }
  if (!views.empty()) out.side_px /= static_cast<double>(views.size());
  if (views.size() < 2) return out;
  const auto pose = pose_covariance(
      cameras, covariance, world_from_tag.translation, corners, views, corner_sigma);
  if (!pose) return out;
  const double turn_rad2 = pose->topLeftCorner<3, 3>().trace();
  const double centre_m2 = pose->bottomRightCorner<3, 3>().trace();
  out.centre_error_m = std::sqrt(centre_m2);
  // The mean of |turn x lever|^2 over all directions of the lever is two thirds of both
  // squared; the correlation of turn and centre averages out.
  out.joint_error_m =
      std::sqrt(centre_m2 + 2.0 / 3.0 * options.lever_m * options.lever_m * turn_rad2);
  return out;
}

RigPlan plan_rig(std::span<const Camera> cameras,
                 const RigCovariance* covariance,
                 const ErrorMapGrid& grid,
                 const CornerSigma& corner_sigma,
                 const PlanOptions& options) {
  MAREY_ASSERT(options.directions > 0);
  const int columns = grid.columns();
  const int rows = grid.rows();
  RigPlan plan;
  for (const double height_m : grid.heights_m) {
    Tally of_height;
    for (int at = 0; at < rows * columns; ++at) {
      const glm::dvec3 p_in_world{grid.min_in_world.x + at % columns * grid.step_m,
                                  height_m,
                                  grid.min_in_world.z + at / columns * grid.step_m};
      Tally of_place;
      for (int k = 0; k < options.directions; ++k) {
        const double angle_rad = 2.0 * std::numbers::pi * k / options.directions;
        const ExpectedTag tag = expect_tag(cameras,
                                           covariance,
                                           upright_tag(p_in_world, angle_rad),
                                           corner_sigma,
                                           options);
        of_place.add(tag);
        of_height.add(tag);
      }
      plan.places.push_back(place_of(p_in_world, of_place));
    }
    plan.heights.push_back(height_of(height_m, of_height));
  }
  return plan;
}

ErrorMapGrid grid_before(std::span<const Camera> cameras) {
  MAREY_ASSERT(!cameras.empty());
  // Least squares of the distances to all axes.
  Eigen::Matrix3d across_all = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Camera& camera : cameras) {
    const RigidTransform world_from_camera = inverse(camera.camera_from_world);
    const Eigen::Vector3d centre = to_eigen(world_from_camera.translation);
    const Eigen::Vector3d axis =
        to_eigen(world_from_camera.rotation * glm::dvec3(0.0, 0.0, 1.0));
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    across_all += across;
    pull += across * centre;
    middle += centre / static_cast<double>(cameras.size());
  }
  const Eigen::LDLT<Eigen::Matrix3d> factor(across_all);
  const bool is_known =
      factor.vectorD().minCoeff() > 1e-3 * static_cast<double>(cameras.size());
  const Eigen::Vector3d target = is_known ? Eigen::Vector3d(factor.solve(pull)) : middle;
  constexpr double kHalf_m = 2.0;
  constexpr double kRound_m = 0.1;  // For readable coordinates.
  const glm::dvec3 around{std::round(target.x() / kRound_m) * kRound_m,
                          0.0,
                          std::round(target.z() / kRound_m) * kRound_m};
  const glm::dvec3 half{kHalf_m, 0.0, kHalf_m};
  return {around - half, around + half, 0.25, ErrorMapGrid{}.heights_m};
}

}  // namespace marey::calib
