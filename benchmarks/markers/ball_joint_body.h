// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/character.h"
#include "core/skeleton.h"

namespace marey {

/// A tree of ball joints on a free root: forward kinematics and its derivatives, in
/// scalars of type T. Only gauss_newton_solver.h includes this file: it is
/// compiled for another processor than the rest.
template <class T>
class BallJointBody {
 public:
  using Vec3 = Eigen::Matrix<T, 3, 1>;
  using Mat3 = Eigen::Matrix<T, 3, 3>;

  struct Posture {
    Vec3 root;
    std::vector<Mat3> parent_from_joint;
  };

  BallJointBody(const Skeleton& skeleton, const std::vector<PointMass>& masses) {
    const std::size_t n = skeleton.joints.size();
    mass_.assign(n, T(0));
    moment_.assign(n, Vec3::Zero());
    for (const Joint& joint : skeleton.joints) {
      parent_.push_back(joint.parent ? static_cast<int>(*joint.parent) : -1);
      offset_.push_back(vec(joint.parent_from_joint.translation));
    }
    double total_kg = 0.0;
    for (const PointMass& m : masses) total_kg += m.mass_kg;
    for (const PointMass& m : masses) {
      mass_[index(m.joint)] += static_cast<T>(m.mass_kg / total_kg);
      moment_[index(m.joint)] += static_cast<T>(m.mass_kg / total_kg) * vec(m.p_in_joint);
    }
    p_.resize(n);
    world_from_joint_.resize(n);
    subtree_mass_.resize(n);
    subtree_moment_.resize(n);
  }

  static Vec3 vec(const glm::dvec3& v) {
    return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
  }

  [[nodiscard]] std::size_t size() const { return parent_.size(); }
  [[nodiscard]] const Vec3& place(JointIndex joint) const { return p_[index(joint)]; }

  void forward(const Posture& posture) {
    p_[0] = posture.root;
    world_from_joint_[0] = posture.parent_from_joint[0];
    for (std::size_t i = 1; i < size(); ++i) {
      const auto a = static_cast<std::size_t>(parent_[i]);
      p_[i] = p_[a] + world_from_joint_[a] * offset_[i];
      world_from_joint_[i].noalias() =
          world_from_joint_[a] * posture.parent_from_joint[i];
    }
  }

  /// Computes the centre of mass of the posture of the last forward(). balance_rows()
  /// uses its intermediate results.
  [[nodiscard]] Vec3 centre_of_mass() {
    for (std::size_t i = 0; i < size(); ++i) {
      subtree_mass_[i] = mass_[i];
      subtree_moment_[i] = mass_[i] * p_[i] + world_from_joint_[i] * moment_[i];
    }
    for (std::size_t i = size(); i-- > 1;) {
      const auto a = static_cast<std::size_t>(parent_[i]);
      subtree_mass_[a] += subtree_mass_[i];
      subtree_moment_[a] += subtree_moment_[i];
    }
    return subtree_moment_[0];
  }

  /// Writes three rows: the derivatives of a joint's position by the root's position and
  /// by rotations about the world's axes. Columns of joints outside its chain are
  /// unchanged.
  template <class Rows>
  void point_rows(JointIndex joint, T weight, Rows&& rows) const {
    rows.template leftCols<3>() = weight * Mat3::Identity();
    for (int i = static_cast<int>(joint); i >= 0;
         i = parent_[static_cast<std::size_t>(i)]) {
      const Vec3 r = weight * (place(joint) - p_[static_cast<std::size_t>(i)]);
      auto block = rows.template block<3, 3>(0, 3 + 3 * i);
      block << 0, r[2], -r[1], -r[2], 0, r[0], r[1], -r[0], 0;
    }
  }

  /// Writes two rows: the same derivatives of the centre of mass, along x and z.
  /// Precondition: centre_of_mass() of this posture.
  template <class Rows>
  void balance_rows(Rows&& rows) const {
    rows.template leftCols<3>() << 1, 0, 0, 0, 0, 1;
    for (std::size_t i = 0; i < size(); ++i) {
      const Vec3 r = subtree_moment_[i] - subtree_mass_[i] * p_[i];
      const auto column = static_cast<Eigen::Index>(3 + 3 * i);
      rows.template block<2, 3>(0, column) << 0, r[2], -r[1], r[1], -r[0], 0;
    }
  }

  /// Moves the root and rotates each joint about a world axis, from the joint rotations
  /// of the last forward().
  template <class Step>
  void apply(const Step& step, Posture& posture) const {
    posture.root += step.template head<3>();
    for (std::size_t i = 0; i < size(); ++i) {
      Vec3 turn = step.template segment<3>(static_cast<Eigen::Index>(3 + 3 * i));
      T angle = turn.norm();
      if (angle < T(1e-12)) continue;
      turn /= angle;
      angle = std::min(angle, kMaxTurn_rad);
      if (parent_[i] >= 0) {
        turn = world_from_joint_[static_cast<std::size_t>(parent_[i])].transpose() * turn;
      }
      Mat3& local = posture.parent_from_joint[i];
      local = Eigen::AngleAxis<T>(angle, turn).toRotationMatrix() * local;
    }
  }

 private:
  static constexpr T kMaxTurn_rad = T(0.5);  // Limit in one step.

  std::vector<int> parent_;
  std::vector<Vec3> offset_;
  std::vector<T> mass_;  // Share of the body's.
  std::vector<Vec3>
      moment_;  // Share times the place of its centre, in the joint's frame.
  std::vector<Vec3> p_;
  std::vector<Mat3> world_from_joint_;
  std::vector<T> subtree_mass_;
  std::vector<Vec3> subtree_moment_;
};

}  // namespace marey
