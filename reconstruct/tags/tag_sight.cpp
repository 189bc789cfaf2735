// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/tag_sight.h"

#include <ceres/jet.h>
#include <glm/gtc/quaternion.hpp>

namespace marey::reconstruct {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TagSight::TagSight(const Camera& camera)
    : lens_(camera.intrinsics.lens),
      parameters_(camera.intrinsics.parameters()),
      shift_(eigen(camera.camera_from_world.translation)) {
  const glm::dquat& q = camera.camera_from_world.rotation;
  camera_from_world_ = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
}

bool TagSight::project(const Vector3d& p_in_world,
                       Eigen::Vector2d& pixel_px,
                       Eigen::Matrix<double, 2, 3>& px_by_world) const {
  // The projection depends on x / z and y / z alone.
  using Jet = ceres::Jet<double, 2>;
  const Vector3d p = camera_from_world_ * p_in_world + shift_;
  if (!(p.z() > 1e-6)) return false;
  const double x = p.x() / p.z();
  const double y = p.y() / p.z();
  const std::array<Jet, 3> ray{Jet(x, 0), Jet(y, 1), Jet(1.0)};
  std::array<Jet, 2> pixel;
  if (!marey::project(lens_, parameters_.data(), ray.data(), pixel.data())) return false;
  Eigen::Matrix2d px_by_ray;
  px_by_ray << pixel[0].v[0], pixel[0].v[1], pixel[1].v[0], pixel[1].v[1];
  Eigen::Matrix<double, 2, 3> ray_by_camera;
  ray_by_camera << 1.0, 0.0, -x, 0.0, 1.0, -y;
  pixel_px = {pixel[0].a, pixel[1].a};
  px_by_world = px_by_ray * (ray_by_camera / p.z()) * camera_from_world_;
  return true;
}

void TagDerivative::add_to(const TagSighted& sighted,
                           double weight,
                           PostureEquations& out) const {
  const auto own = value.leftCols(columns);
  Eigen::Matrix<double, 3, SparseDerivative::kMax> shared;
  Eigen::Matrix<double, 3, SparseDerivative::kMax> explained;
  shared.leftCols(columns).noalias() = sighted.by_shift.transpose().lazyProduct(own);
  explained.leftCols(columns).noalias() =
      sighted.explained.lazyProduct(shared.leftCols(columns));
  const Eigen::Matrix<double, 8, 1> weighted = sighted.weighted(sighted.residual);
  for (int i = 0; i < columns; ++i) {
    const int row = column[static_cast<std::size_t>(i)];
    out.gradient[row] += weight * value.col(i).dot(weighted);
    for (int j = 0; j <= i; ++j) {
      const int at = column[static_cast<std::size_t>(j)];
      const double product =
          weight * (value.col(i).dot(value.col(j)) - shared.col(i).dot(explained.col(j)));
      // Columns are not in ascending order; the lower triangle holds both halves.
      if (row >= at) {
        out.hessian(row, at) += product;
      } else {
        out.hessian(at, row) += product;
      }
    }
  }
}

}  // namespace marey::reconstruct
