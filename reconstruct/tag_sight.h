// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: how a camera sees a tag, with derivatives and without Ceres.

#include <array>

#include <Eigen/Core>

#include "core/camera.h"
#include "reconstruct/posture_equations.h"

namespace marey::reconstruct {

/// A camera as the frame solver wants it.
class TagSight {
 public:
  explicit TagSight(const Camera& camera);

  /// Where a point is seen [px] and how that follows the point [px/m]. False, with both
  /// untouched, when it is not in front of the camera.
  [[nodiscard]] bool project(const Eigen::Vector3d& p_in_world,
                             Eigen::Vector2d& pixel_px,
                             Eigen::Matrix<double, 2, 3>& px_by_world) const;

 private:
  LensModel lens_;
  std::array<double, Intrinsics::kParameterCount> parameters_;
  Eigen::Matrix3d camera_from_world_;
  Eigen::Vector3d shift_;
};

/// A sighting against a posture: eight residuals in sigmas, predicted minus seen, and
/// what they weigh.
struct TagSighted {
  std::array<Eigen::Vector3d, 4> corners_in_world;
  Eigen::Matrix<double, 8, 1> residual;
  Eigen::Matrix<double, 8, 3> by_shift;  ///< Of the tag as a whole, in the world. [1/m]
  /// Their inverse covariance is I - by_shift * explained * by_shift^T: what the tag's
  /// slip on the body explains is no error of its corners (tag_slip.h).
  Eigen::Matrix3d explained;

  /// The information that `x` and `y`, 8 rows each, have in common.
  [[nodiscard]] Eigen::Matrix<double, 8, 1> weighed(
      const Eigen::Matrix<double, 8, 1>& x) const {
    const Eigen::Vector3d shift = explained * (by_shift.transpose() * x);
    return x - by_shift * shift;
  }
  [[nodiscard]] double squared() const { return residual.dot(weighed(residual)); }
};

/// How the eight residuals follow a posture's unknowns.
struct TagDerivative {
  int columns = 0;
  std::array<int, SparseDerivative::kMost> column{};
  Eigen::Matrix<double, 8, SparseDerivative::kMost> value;

  /// Adds the sighting to equations with a weight; the cost is the caller's.
  void add_to(const TagSighted& sighted, double weight, PostureEquations& out) const;
};

}  // namespace marey::reconstruct
