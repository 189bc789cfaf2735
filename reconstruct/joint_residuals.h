// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: how markers on two segments are seen, hinged at a joint. A
// frame's unknowns are nine: the first segment's place, the turn that is added to what it
// was started with, and the joint's rotation vector, from the second to the first.

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

  /// Where the marker is on its segment, whose shape is that at the mean turn.
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

/// Of a marker on the first segment.
struct SeenOnA : Seen {
  template <class T>
  bool operator()(const T* frame, const T* shape, const T* soft, T* residual) const {
    T p_in_a[3];
    carry(shape, soft, frame + 6, p_in_a);
    compare(frame, p_in_a, residual);
    return true;
  }
};

/// Of a marker on the second one.
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

/// That soft tissue carries a marker by little.
struct FirmTissue {
  double sigma_m_per_rad = 1.0;

  template <class T>
  bool operator()(const T* soft, T* residual) const {
    for (int i = 0; i < 9; ++i) residual[i] = soft[i] / sigma_m_per_rad;
    return true;
  }
};

}  // namespace marey::reconstruct
