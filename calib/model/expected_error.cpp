// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/expected_error.h"

#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <ceres/jet.h>

#include "calib/model/project_point.h"
#include "core/base/assert.h"

namespace marey::calib {
namespace {

constexpr int kPerCamera = static_cast<int>(RigCovariance::kPerCamera);

struct Counts {
  int columns;
  int rows;
};

Counts counts_of(const ErrorMapGrid& grid) {
  MAREY_ASSERT(grid.step_m > 0.0);
  const glm::dvec3 extent = grid.max_in_world - grid.min_in_world;
  const double columns = std::floor(extent.x / grid.step_m + 1e-9) + 1.0;
  const double rows = std::floor(extent.z / grid.step_m + 1e-9) + 1.0;
  MAREY_ASSERT(columns >= 1.0 && rows >= 1.0);
  MAREY_ASSERT(columns * rows <= std::numeric_limits<int>::max());
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

}  // namespace

int ErrorMapGrid::columns() const {
  return counts_of(*this).columns;
}

int ErrorMapGrid::rows() const {
  return counts_of(*this).rows;
}

std::vector<CameraId> cameras_that_see(std::span<const Camera> cameras,
                                       const glm::dvec3& p_in_world,
                                       double margin_px) {
  std::vector<CameraId> out;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const auto pixel = project(cameras[c], p_in_world);
    const Intrinsics& k = cameras[c].intrinsics;
    const bool inside = pixel && pixel->x >= margin_px && pixel->y >= margin_px &&
                        pixel->x <= k.width_px - 1 - margin_px &&
                        pixel->y <= k.height_px - 1 - margin_px;
    // Far outside the image, the distortion may fold back into it.
    if (inside && unproject(k, *pixel)) out.push_back(CameraId{static_cast<int>(c)});
  }
  return out;
}

std::optional<glm::dmat3> point_covariance(std::span<const Camera> cameras,
                                           std::span<const CameraId> seen_by,
                                           const RigCovariance* covariance,
                                           const glm::dvec3& p_in_world,
                                           double sigma_px) {
  MAREY_ASSERT(sigma_px > 0.0);
  MAREY_ASSERT(!covariance || covariance->cameras == cameras.size());
  if (seen_by.size() < 2) return std::nullopt;
  const double weight = 1.0 / (sigma_px * sigma_px);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  // Column block i: derivative of the normal equations' right side by camera i's errors.
  Eigen::MatrixXd by_camera_errors(
      3, kPerCamera * static_cast<Eigen::Index>(seen_by.size()));
  for (std::size_t i = 0; i < seen_by.size(); ++i) {
    MAREY_ASSERT(index(seen_by[i]) < cameras.size());
    const auto sight = project_point(cameras[index(seen_by[i])], p_in_world);
    if (!sight) return std::nullopt;
    information += weight * sight->by_point.transpose() * sight->by_point;
    by_camera_errors.middleCols<kPerCamera>(kPerCamera * static_cast<Eigen::Index>(i)) =
        weight * sight->by_point.transpose() * sight->by_camera;
  }
  const Eigen::LDLT<Eigen::Matrix3d> factor(information);
  const Eigen::Vector3d pivots = factor.vectorD();
  // For parallel rays, one direction is ten million times less certain than another.
  if (!(pivots.minCoeff() > 1e-14 * pivots.maxCoeff())) return std::nullopt;
  Eigen::Matrix3d out = factor.solve(Eigen::Matrix3d::Identity());
  if (covariance) {
    const Eigen::MatrixXd gain = factor.solve(by_camera_errors);
    Eigen::MatrixXd uncertainty(gain.cols(), gain.cols());
    for (Eigen::Index row = 0; row < uncertainty.rows(); ++row) {
      for (Eigen::Index column = 0; column < uncertainty.cols(); ++column) {
        const auto place = [&](Eigen::Index k) {
          return RigCovariance::kPerCamera *
                     index(seen_by[static_cast<std::size_t>(k / kPerCamera)]) +
                 static_cast<std::size_t>(k % kPerCamera);
        };
        uncertainty(row, column) = covariance->at(place(row), place(column));
      }
    }
    out += gain * uncertainty * gain.transpose();
  }
  glm::dmat3 result(0.0);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      result[column][row] = 0.5 * (out(row, column) + out(column, row));
    }
  }
  return result;
}

double expected_error_m(const glm::dmat3& point_covariance_m2) {
  return std::sqrt(point_covariance_m2[0][0] + point_covariance_m2[1][1] +
                   point_covariance_m2[2][2]);
}

std::vector<ErrorMapPlace> error_map(std::span<const Camera> cameras,
                                     const RigCovariance* covariance,
                                     const ErrorMapGrid& grid,
                                     double sigma_px) {
  const auto [columns, rows] = counts_of(grid);
  std::vector<ErrorMapPlace> map;
  for (const double height_m : grid.heights_m) {
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        ErrorMapPlace place;
        place.p_in_world = {grid.min_in_world.x + column * grid.step_m,
                            height_m,
                            grid.min_in_world.z + row * grid.step_m};
        const auto seen_by = cameras_that_see(cameras, place.p_in_world);
        place.seen_by = static_cast<int>(seen_by.size());
        const auto found =
            point_covariance(cameras, seen_by, covariance, place.p_in_world, sigma_px);
        if (found) place.error_m = expected_error_m(*found);
        map.push_back(place);
      }
    }
  }
  return map;
}

}  // namespace marey::calib
