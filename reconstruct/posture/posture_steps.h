// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a posture's unknowns, small steps in them, and rotations as
// Eigen types.

#include <array>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "reconstruct/posture/posture.h"

namespace marey::reconstruct {

/// The unknowns of a posture in the order in which their equations are solved: limb after
/// limb, the trunk last, since limbs are coupled only through the trunk. The three
/// unknowns of a rotation are the rotation vector of a small turn in the world, applied
/// last.
inline constexpr int kTrunkFreedom = 18;
inline constexpr std::array<int, 4> kLimbFreedom{12, 12, 9, 9};
inline constexpr std::array<int, 4> kLimbColumn{0, 12, 24, 33};
inline constexpr int kTrunkColumn = 42;
static_assert(kTrunkColumn + kTrunkFreedom == kPostureFreedom);

/// Returns the first column of a parameter.
[[nodiscard]] constexpr int column_of(PoseParameter parameter) {
  constexpr std::array<int, kPoseParameterCount> columns{
      kTrunkColumn,       // hips' position
      kTrunkColumn + 3,   // hips
      kTrunkColumn + 6,   // abdomen's end
      kTrunkColumn + 9,   // thorax
      kTrunkColumn + 12,  // neck
      kTrunkColumn + 15,  // head
      0,
      12,  // shoulders
      3,
      15,
      24,
      33,  // limbs' frames
      6,
      18,
      27,
      36,  // hands, feet
      9,
      21,
      30,
      39,  // flexions
      10,
      22,
      31,
      40,  // twists of the lower bones
      11,
      23,
      32,
      41,  // twists of the upper bones
  };
  return columns[index(parameter)];
}

using PostureVector = Eigen::Matrix<double, kPostureFreedom, 1>;
using PostureMatrix = Eigen::Matrix<double, kPostureFreedom, kPostureFreedom>;

/// Moves a posture by a step in its unknowns.
void move(Posture& posture, const PostureVector& step);

/// Returns the step from `from` to `to`: the inverse of move(), rotations by the shorter
/// way.
[[nodiscard]] PostureVector step_between(const Posture& from, const Posture& to);

/// The same with the rotation of each limb's upper bone in place of its frame's.
/// Measurements of an upper bone alone then carry no information on the limb's flexion,
/// as required by a prior that treats the parameters as independent.
void move_bones(Posture& posture, const PostureVector& step, const Lengths& lengths);
[[nodiscard]] PostureVector bone_step_between(const Posture& from,
                                              const Posture& to,
                                              const Lengths& lengths);

/// Returns the derivative of the rotation of a limb's upper bone, its twist excluded, by
/// the limb's flexion.
[[nodiscard]] Eigen::Vector3d upper_by_flexion(const Posture& posture,
                                               std::size_t limb,
                                               const Lengths& lengths);

/// Angle between a limb's upper bone and its frame, and its derivative by flexion.
struct LimbLean {
  double rad = 0.0;
  double rate = 0.5;
};
[[nodiscard]] LimbLean lean_of(std::size_t limb, double flexion, const Lengths& lengths);

/// Returns the value of a rotation.
[[nodiscard]] inline Eigen::Quaterniond quaternion(const Posture& posture,
                                                   PoseParameter parameter) {
  const double* q = posture.block(parameter);
  return {q[3], q[0], q[1], q[2]};
}
[[nodiscard]] inline Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
/// Convert a rotation vector to a rotation, and a unit quaternion to a rotation vector by
/// the shorter way: core's functions, for Eigen.
[[nodiscard]] Eigen::Quaterniond turn_by(const Eigen::Vector3d& vector_rad);
[[nodiscard]] Eigen::Vector3d log_of(Eigen::Quaterniond rotation);

}  // namespace marey::reconstruct
