// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "calib/model/rig_covariance.h"
#include "core/base/ids.h"
#include "core/camera.h"

namespace marey::calib {

/// Returns the cameras in whose image a point appears, at least `margin_px` from its
/// edge. Occlusion is not modelled.
[[nodiscard]] std::vector<CameraId> cameras_that_see(std::span<const Camera> cameras,
                                                     const glm::dvec3& p_in_world,
                                                     double margin_px = 0.0);

/// Returns the covariance [m^2], in the world, of the triangulated position of a point at
/// `p_in_world`: each of the cameras `seen_by` sees it with errors of `sigma_px` per
/// image coordinate, and the cameras have errors with `covariance`. Null for cameras
/// without errors. Camera errors count to first order.
///
/// Returns nullopt if the geometry determines no position: fewer than two cameras, all
/// rays parallel, or the point behind a camera. Cost: microseconds per camera.
/// Preconditions: sigma_px > 0; `seen_by` names cameras of the span; the covariance has
/// the same number of cameras.
[[nodiscard]] std::optional<glm::dmat3> point_covariance(
    std::span<const Camera> cameras,
    std::span<const CameraId> seen_by,
    const RigCovariance* covariance,
    const glm::dvec3& p_in_world,
    double sigma_px);

/// Returns the root of the expected squared distance [m] of a point from its true
/// position.
[[nodiscard]] double expected_error_m(const glm::dmat3& point_covariance_m2);

/// Positions of an error map: a grid over the floor, at several heights.
struct ErrorMapGrid {
  glm::dvec3 min_in_world{-2.0, 0.0, -2.0};      ///< Its y is not used.
  glm::dvec3 max_in_world{2.0, 0.0, 2.0};        ///< Its y is not used.
  double step_m = 0.1;                           ///< Along x and z.
  std::vector<double> heights_m{0.1, 0.9, 1.5};  ///< Ankle, hip, shoulder.

  /// Return the number of positions along x and along z, both ends of a side included if
  /// steps reach them.
  /// Preconditions: step_m > 0; the maximum is not below the minimum; an int holds the
  /// number of positions at one height.
  [[nodiscard]] int columns() const;
  [[nodiscard]] int rows() const;
};

struct ErrorMapPlace {
  glm::dvec3 p_in_world{0.0};
  int seen_by = 0;  ///< Cameras that see the point.
  /// expected_error_m(); nullopt as in point_covariance().
  std::optional<double> error_m;
};

/// Returns expected_error_m() for a point at every position of a grid, from all cameras
/// that see it: by height, then z, then x. Preconditions: as for columns() and
/// point_covariance().
[[nodiscard]] std::vector<ErrorMapPlace> error_map(std::span<const Camera> cameras,
                                                   const RigCovariance* covariance,
                                                   const ErrorMapGrid& grid,
                                                   double sigma_px);

}  // namespace marey::calib
