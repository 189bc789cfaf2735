// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: a rigid motion as a spline.

#include <array>

#include <Eigen/Dense>

namespace marey::calib {

/// Solver parameters of a pose: rotation x, y, z, w, then translation. A step rotates it
/// by a rotation vector in the target frame (on the left), and adds to the translation.
using PoseBlock = std::array<double, 7>;

/// A pose, and its derivatives by four knots and by the time between them.
struct SplinePose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  /// Derivative of the rotation's step by the step of each knot's rotation.
  std::array<Eigen::Matrix3d, 4> rotation_by_knot;
  /// Derivative of the translation by the translation of each knot.
  std::array<double, 4> translation_by_knot{};
  Eigen::Vector3d rotation_by_u;     ///< Rotation vector per unit of u.
  Eigen::Vector3d translation_by_u;  ///< Per unit of u.
};

/// Evaluates the cumulative cubic B-spline through (near) knots 1 and 2 of four, at the
/// fraction `u` from the second to the third: C. Sommer et al., "Efficient derivative
/// computation for cumulative B-splines on Lie groups", 2020, eq. 11, applied separately
/// to rotations and translations. u may be slightly outside 0..1: the polynomial is
/// extrapolated.
[[nodiscard]] SplinePose spline_pose(const std::array<const double*, 4>& knots, double u);

}  // namespace marey::calib
