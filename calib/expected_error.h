// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/camera.h"
#include "core/ids.h"

namespace marey::calib {

/// The covariance of all parameters of all cameras of a rig, together: cameras that were
/// found from the same sightings err together.
///
/// Per camera, in this order: Intrinsics::parameters() (of terms that the lens does not
/// have, and of what was held fixed, zero); the rotation vector, in the world [rad], that
/// takes the camera's true attitude to the one found; its centre in the world [m].
struct RigCovariance {
  static constexpr std::size_t kPerCamera = Intrinsics::kParameterCount + 6;

  std::size_t cameras = 0;
  std::vector<double> values;  ///< Row by row, size() by size().

  [[nodiscard]] std::size_t size() const { return kPerCamera * cameras; }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * size() + column];
  }
};

/// The cameras in whose image a point appears, at least `margin_px` from its edge.
/// Nothing stands in the way of a sight here.
[[nodiscard]] std::vector<CameraId> cameras_that_see(std::span<const Camera> cameras,
                                                     const glm::dvec3& p_in_world,
                                                     double margin_px = 0.0);

/// Covariance [m^2] of the place, in the world, at which a point would be triangulated
/// that really is at `p_in_world`: each of the cameras `seen_by` sees it with errors of
/// `sigma_px` per image coordinate, and is itself known no better than `covariance` says.
/// Null for cameras that are known exactly. Camera errors matter to first order.
///
/// nullopt when the geometry gives no place: fewer than two cameras, all their rays
/// parallel, or the point behind one of them. Cost: microseconds per camera.
/// Preconditions: sigma_px > 0; `seen_by` names cameras of the span; the covariance is of
/// as many cameras.
[[nodiscard]] std::optional<glm::dmat3> point_covariance(
    std::span<const Camera> cameras,
    std::span<const CameraId> seen_by,
    const RigCovariance* covariance,
    const glm::dvec3& p_in_world,
    double sigma_px);

/// The root of the expected squared distance [m] of a point from its true place.
[[nodiscard]] double expected_error_m(const glm::dmat3& point_covariance_m2);

/// Where an error map is wanted: a grid over the floor, at several heights.
struct ErrorMapGrid {
  glm::dvec3 least_in_world{-2.0, 0.0, -2.0};    ///< Its y is not used.
  glm::dvec3 greatest_in_world{2.0, 0.0, 2.0};   ///< Likewise.
  double step_m = 0.1;                           ///< Along x and z.
  std::vector<double> heights_m{0.1, 0.9, 1.5};  ///< Ankle, hip, shoulder.

  /// Places along x and along z, both ends of a side counted where steps reach them.
  /// Preconditions: step_m > 0, greatest not below least, and no more places at one
  /// height than an int holds.
  [[nodiscard]] int columns() const;
  [[nodiscard]] int rows() const;
};

struct ErrorMapPlace {
  glm::dvec3 p_in_world{0.0};
  int seen_by = 0;                ///< Cameras that see it.
  std::optional<double> error_m;  ///< expected_error_m(); nullopt as point_covariance().
};

/// expected_error_m() for a point at every place of a grid, from all cameras that see it:
/// by height, then z, then x. Preconditions: as of columns() and point_covariance().
[[nodiscard]] std::vector<ErrorMapPlace> error_map(std::span<const Camera> cameras,
                                                   const RigCovariance* covariance,
                                                   const ErrorMapGrid& grid,
                                                   double sigma_px);

}  // namespace marey::calib
