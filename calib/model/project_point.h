// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: a projection with its derivatives.

#include <array>
#include <optional>

#include <Eigen/Dense>
#include <ceres/jet.h>
#include <glm/gtc/quaternion.hpp>

#include "calib/model/rig_covariance.h"
#include "core/base/cross_matrix.h"
#include "core/camera.h"

namespace marey::calib {

[[nodiscard]] inline Eigen::Quaterniond to_eigen(const glm::dquat& q) {
  return {q.w, q.x, q.y, q.z};
}

[[nodiscard]] inline Eigen::Vector3d to_eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// A pixel and its derivatives.
struct PixelOfPoint {
  Eigen::Vector2d pixel_px;
  Eigen::Matrix<double, 2, 3> by_point;  ///< In the camera's frame.
  Eigen::Matrix<double, 2, Intrinsics::kParameterCount> by_lens;
};

/// Returns project() and its derivatives; nullopt if project() has no result.
[[nodiscard]] inline std::optional<PixelOfPoint> pixel_of_point(
    LensModel lens, const double* parameters, const Eigen::Vector3d& p_in_camera) {
  constexpr int kLens = Intrinsics::kParameterCount;
  using Jet = ceres::Jet<double, kLens + 3>;
  std::array<Jet, kLens> k;
  std::array<Jet, 3> p;
  for (int i = 0; i < kLens; ++i) k[static_cast<std::size_t>(i)] = Jet(parameters[i], i);
  for (int i = 0; i < 3; ++i) {
    p[static_cast<std::size_t>(i)] = Jet(p_in_camera[i], kLens + i);
  }
  std::array<Jet, 2> pixel;
  if (!project(lens, k.data(), p.data(), pixel.data())) return std::nullopt;
  PixelOfPoint out;
  for (int i = 0; i < 2; ++i) {
    const Jet& value = pixel[static_cast<std::size_t>(i)];
    out.pixel_px[i] = value.a;
    out.by_lens.row(i) = value.v.head<kLens>().transpose();
    out.by_point.row(i) = value.v.tail<3>().transpose();
  }
  return out;
}

/// The pixel of a world point, and its derivatives by point and camera.
struct ProjectedPoint {
  Eigen::Vector2d pixel_px;
  Eigen::Matrix<double, 2, 3> by_point;  ///< In the world.
  /// In the order of RigCovariance.
  Eigen::Matrix<double, 2, static_cast<int>(RigCovariance::kPerCamera)> by_camera;
};

/// Returns the projection of a world point; nullopt if project() has no result.
[[nodiscard]] inline std::optional<ProjectedPoint> project_point(
    const Camera& camera, const glm::dvec3& p_in_world) {
  const RigidTransform world_from_camera = inverse(camera.camera_from_world);
  const Eigen::Matrix3d camera_from_world =
      to_eigen(camera.camera_from_world.rotation).toRotationMatrix();
  const Eigen::Vector3d from_centre =
      to_eigen(p_in_world - world_from_camera.translation);
  const auto pixel = pixel_of_point(camera.intrinsics.lens,
                                    camera.intrinsics.parameters().data(),
                                    camera_from_world * from_centre);
  if (!pixel) return std::nullopt;
  ProjectedPoint out;
  out.pixel_px = pixel->pixel_px;
  out.by_point = pixel->by_point * camera_from_world;
  out.by_camera << pixel->by_lens,
      out.by_point * cross_matrix<Eigen::Matrix3d>(from_centre), -out.by_point;
  return out;
}

}  // namespace marey::calib
