// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: a rigid motion that is smooth between its knots.

#include <array>

#include <Eigen/Dense>

namespace marey::calib {

/// A pose as a solver moves it: rotation x, y, z, w, then translation. A step turns it by
/// a rotation vector in the target frame (on the left), and adds to the translation.
using PoseBlock = std::array<double, 7>;

/// A pose, and how it follows four knots and the time between them.
struct SplinePose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  /// A step of the rotation by a step of each knot's rotation.
  std::array<Eigen::Matrix3d, 4> rotation_by_knot;
  /// Of the translation by each knot's.
  std::array<double, 4> translation_by_knot{};
  Eigen::Vector3d rotation_by_u;     ///< Rotation vector per unit of u.
  Eigen::Vector3d translation_by_u;  ///< Per unit of u.
};

/// The cumulative cubic B-spline through (near) knots 1 and 2 of four, `u` of the way
/// from the second to the third: C. Sommer et al., "Efficient derivative computation for
/// cumulative B-splines on Lie groups", 2020, eq. 11, on rotations and translations
/// apart. u may leave 0..1 a little: the polynomial goes on.
[[nodiscard]] SplinePose spline_pose(const std::array<const double*, 4>& knots, double u);

}  // namespace marey::calib
