// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: residuals of markers on two segments that are hinged at a
// joint. The unknowns of a frame are nine: the first segment's place, a correction to its
// initial rotation, and the joint's rotation vector, from the second to the first.

#include <Eigen/Core>
#include <ceres/rotation.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey::reconstruct {

/// A marker's sample; a is the first segment.
struct Seen {
  glm::dvec3 p_in_world;
  glm::dquat world_from_a;
  Eigen::Vector3d mean_turn;
  double sigma_m;

  /// Computes the marker's place on its segment; the segment's shape is that at the mean
  /// turn.
  template <class T>
  void carry(const T* shape, const T* soft, const T* turn, T* p) const {
    for (int i = 0; i < 3; ++i) {
      p[i] = shape[i];
      for (int j = 0; j < 3; ++j) p[i] += soft[3 * i + j] * (turn[j] - mean_turn[j]);
    }
  }

  template <class T>
  void compare(const T* frame, const T* p_in_a, T* residual) const {
    const T q[4] = {
        T(world_from_a.w), T(world_from_a.x), T(world_from_a.y), T(world_from_a.z)};
    T turned[3];
    ceres::UnitQuaternionRotatePoint(q, p_in_a, turned);
    T p[3];
    ceres::AngleAxisRotatePoint(frame + 3, turned, p);
    for (int i = 0; i < 3; ++i) {
      residual[i] = (p[i] + frame[i] - p_in_world[i]) / sigma_m;
    }
  }
};

/// Sample of a marker on the first segment.
struct SeenOnA : Seen {
  template <class T>
  bool operator()(const T* frame, const T* shape, const T* soft, T* residual) const {
    T p_in_a[3];
    carry(shape, soft, frame + 6, p_in_a);
    compare(frame, p_in_a, residual);
    return true;
  }
};

/// Sample of a marker on the second segment.
struct SeenOnB : Seen {
  template <class T>
  bool operator()(const T* frame,
                  const T* shape,
                  const T* soft,
                  const T* joint_in_a,
                  const T* joint_in_b,
                  T* residual) const {
    T p_in_b[3];
    carry(shape, soft, frame + 6, p_in_b);
    for (int i = 0; i < 3; ++i) p_in_b[i] -= joint_in_b[i];
    T p_in_a[3];
    ceres::AngleAxisRotatePoint(frame + 6, p_in_b, p_in_a);
    for (int i = 0; i < 3; ++i) p_in_a[i] += joint_in_a[i];
    compare(frame, p_in_a, residual);
    return true;
  }
};

/// Prior: soft tissue moves a marker by little.
struct FirmTissue {
  double sigma_m_per_rad = 1.0;

  template <class T>
  bool operator()(const T* soft, T* residual) const {
    for (int i = 0; i < 9; ++i) residual[i] = soft[i] / sigma_m_per_rad;
    return true;
  }
};

}  // namespace marey::reconstruct
