// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: position of every point of a body and its analytic derivatives
// by the posture's unknowns. For solvers whose time budget excludes automatic derivatives
// and allocations.

#include <array>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "reconstruct/posture/posture_steps.h"

namespace marey::reconstruct {

/// A derivative of three coordinates that depends on few unknowns.
struct SparseDerivative {
  static constexpr int kMax = 24;
  int columns = 0;
  std::array<int, kMax> column{};        ///< Columns of the posture's unknowns.
  Eigen::Matrix<double, 3, kMax> value;  ///< The first `columns` are valid.
  void clear() { columns = 0; }
  void add(int first_column, const Eigen::Matrix3d& block);
  void add(int at_column, const Eigen::Vector3d& block);
};

/// Every bone's frame in the world, and the quantities that derivatives need. Toes have
/// their foot's frame, with which they move.
class UnfoldedPosture {
 public:
  /// Computes all frames. Some 2 microseconds. No allocation.
  void unfold(const Posture& posture, const Lengths& lengths, const BodyConstants& body);

  [[nodiscard]] const Eigen::Matrix3d& rotation(HumanBone bone) const {
    return bones_[index(bone)].rotation;
  }
  [[nodiscard]] const Eigen::Vector3d& origin(HumanBone bone) const {
    return bones_[index(bone)].origin;
  }
  [[nodiscard]] Eigen::Vector3d point(HumanBone bone,
                                      const Eigen::Vector3d& p_in_bone) const {
    return rotation(bone) * p_in_bone + origin(bone);
  }

  /// Computes the derivative of a point that moves with `bone`, now at `p_in_world`, by
  /// the unknowns.
  void derivative(HumanBone bone,
                  const Eigen::Vector3d& p_in_world,
                  SparseDerivative& out) const;

  /// Computes the derivative of the bone's rotation, as a rotation vector in the world.
  void turn_derivative(HumanBone bone, SparseDerivative& out) const;

  /// Computes the derivative of a point that moves with `bone`, now at `p_in_world`, by
  /// the body's shape; columns are positions in Lengths, then hinge_column().
  void shape_derivative(HumanBone bone,
                        const Eigen::Vector3d& p_in_world,
                        SparseDerivative& out) const;

 private:
  struct Bone {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d origin;
  };
  struct Limb {
    Eigen::Vector3d lean_axis_in_world;   ///< Axis about which the upper bone leans.
    Eigen::Vector3d hinge_in_world;       ///< Axis about which the lower bone bends.
    Eigen::Vector3d upper_tilt_in_world;  ///< HingeShape's axis before the bend,
    Eigen::Vector3d lower_tilt_in_world;  ///< and after it.
    Eigen::Vector3d upper_axis_in_world;
    Eigen::Vector3d lower_axis_in_world;
    Eigen::Vector3d back_in_world;  ///< Direction of the rollback.
    double rolled = 0.0;  ///< Share of the rollback, and its derivative by flexion.
    double rolled_rate = 0.0;
    double rollback_m = 0.0;
    double lean_rate = 0.0;      ///< Derivative of the upper bone's lean by flexion.
    double lean_by_upper = 0.0;  ///< Derivative of the upper bone's lean by its own
                                 ///< length. [rad/m]
    double lean_by_lower = 0.0;  ///< Derivative of the upper bone's lean by the lower
                                 ///< bone's length. [rad/m]
  };

  void unfold_trunk(const Posture& posture, const Lengths& lengths);
  void unfold_limb(std::size_t limb,
                   const Eigen::Vector3d& root,
                   const Posture& posture,
                   const Lengths& lengths,
                   const HingeShape& shape);
  void limb_derivative(std::size_t limb,
                       int place,
                       const Eigen::Vector3d& p_in_world,
                       SparseDerivative& out) const;
  void thorax_base(SparseDerivative& out) const;
  void limb_shape_derivative(std::size_t limb,
                             int place,
                             const Eigen::Vector3d& p_in_world,
                             SparseDerivative& out) const;

  std::array<Bone, kHumanBoneCount> bones_;
  std::array<Limb, 4> limbs_;
  /// Derivatives of the spine bone's rotation, half way between, by hips and abdomen's
  /// end.
  Eigen::Matrix3d spine_by_hips_;
  Eigen::Matrix3d spine_by_abdomen_;
  /// Derivatives of the chest's and the thorax's origin by the same.
  Eigen::Matrix3d chest_by_hips_;
  Eigen::Matrix3d chest_by_abdomen_;
  Eigen::Matrix3d thorax_by_hips_;
  Eigen::Matrix3d thorax_by_abdomen_;
};

/// Derivatives of the rotation half way between two by each: halves at small angles.
struct HalfwayDerivative {
  Eigen::Matrix3d by_lower;
  Eigen::Matrix3d by_upper;
};
[[nodiscard]] HalfwayDerivative halfway_derivative(const Eigen::Quaterniond& lower,
                                                   const Eigen::Quaterniond& upper);

/// d log(exp(x) R) / dx at x = 0, for r = log(R): the inverse of the left Jacobian of
/// SO(3) (Sola, Deray & Atchuthan 2018, eq. 146).
[[nodiscard]] Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& r);

}  // namespace marey::reconstruct
