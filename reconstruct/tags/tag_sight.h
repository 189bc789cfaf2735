// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: projection of a tag into a camera, with derivatives and without
// Ceres.

#include <array>

#include <Eigen/Core>

#include "core/camera.h"
#include "reconstruct/posture/posture_equations.h"

namespace marey::reconstruct {

/// A camera with precomputed projection for the frame solver.
class TagSight {
 public:
  explicit TagSight(const Camera& camera);

  /// Computes the projection of a point [px] and its derivative by the point [px/m].
  /// False, with both unchanged, if the point is not in front of the camera.
  [[nodiscard]] bool project(const Eigen::Vector3d& p_in_world,
                             Eigen::Vector2d& pixel_px,
                             Eigen::Matrix<double, 2, 3>& px_by_world) const;

 private:
  LensModel lens_;
  std::array<double, Intrinsics::kParameterCount> parameters_;
  Eigen::Matrix3d camera_from_world_;
  Eigen::Vector3d shift_;
};

/// A sighting compared with a posture: eight residuals in sigmas, predicted minus seen,
/// and their information.
struct TagSighted {
  std::array<Eigen::Vector3d, 4> corners_in_world;
  Eigen::Matrix<double, 8, 1> residual;
  Eigen::Matrix<double, 8, 3> by_shift;  ///< By a shift of the whole tag in the world.
                                         ///< [1/m]
  /// The inverse covariance of the residuals is I - by_shift * explained * by_shift^T:
  /// the part that the tag's slip on the body explains is not an error of its corners
  /// (soft_tissue_noise.h).
  Eigen::Matrix3d explained;

  /// Multiplies `x`, 8 rows, by the inverse covariance of the residuals.
  [[nodiscard]] Eigen::Matrix<double, 8, 1> weighted(
      const Eigen::Matrix<double, 8, 1>& x) const {
    const Eigen::Vector3d shift = explained * (by_shift.transpose() * x);
    return x - by_shift * shift;
  }
  [[nodiscard]] double squared() const { return residual.dot(weighted(residual)); }
};

/// Derivative of the eight residuals by a posture's unknowns.
struct TagDerivative {
  int columns = 0;
  std::array<int, SparseDerivative::kMax> column{};
  Eigen::Matrix<double, 8, SparseDerivative::kMax> value;

  /// Adds the sighting to equations with a weight. Does not add the cost.
  void add_to(const TagSighted& sighted, double weight, PostureEquations& out) const;
};

}  // namespace marey::reconstruct
