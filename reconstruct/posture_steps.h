// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a posture's unknowns, small steps in them, and rotations as
// Eigen has them.

#include <array>
#include <cstddef>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "reconstruct/posture.h"

namespace marey::reconstruct {

/// The unknowns of a posture in the order in which their equations are solved: limb after
/// limb, the trunk last, since limbs meet nowhere else. A rotation's three are the
/// rotation vector of a small turn in the world, applied last.
inline constexpr int kTrunkFreedom = 18;
inline constexpr std::array<int, 4> kLimbFreedom{12, 12, 9, 9};
inline constexpr std::array<int, 4> kLimbColumn{0, 12, 24, 33};
inline constexpr int kTrunkColumn = 42;
static_assert(kTrunkColumn + kTrunkFreedom == kPostureFreedom);

/// First column of a slot.
[[nodiscard]] constexpr int column_of(Slot slot) {
  constexpr std::array<int, kSlotCount> columns{
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
  return columns[index(slot)];
}

using PostureVector = Eigen::Matrix<double, kPostureFreedom, 1>;
using PostureMatrix = Eigen::Matrix<double, kPostureFreedom, kPostureFreedom>;

/// Moves a posture by a step in its unknowns.
void move(Posture& posture, const PostureVector& step);

/// The step that takes `from` to `to`: move()'s inverse, rotations by the shorter way.
[[nodiscard]] PostureVector step_between(const Posture& from, const Posture& to);

/// The same with the turn of each limb's upper bone in place of its frame's. What is seen
/// of an upper bone alone then says nothing of the limb's flexion, as it should where a
/// prior knows each slot by itself.
void move_bones(Posture& posture, const PostureVector& step, const Lengths& lengths);
[[nodiscard]] PostureVector bone_step_between(const Posture& from,
                                              const Posture& to,
                                              const Lengths& lengths);

/// How the turn of a limb's upper bone, its twist aside, follows the limb's flexion.
[[nodiscard]] Eigen::Vector3d upper_by_flexion(const Posture& posture,
                                               std::size_t limb,
                                               const Lengths& lengths);

/// How far a limb's upper bone leans back from its frame, and how that follows flexion.
struct LimbLean {
  double rad = 0.0;
  double rate = 0.5;
};
[[nodiscard]] LimbLean lean_of(std::size_t limb, double flexion, const Lengths& lengths);

/// A rotation slot's value.
[[nodiscard]] inline Eigen::Quaterniond quaternion(const Posture& posture, Slot slot) {
  const double* q = posture.block(slot);
  return {q[3], q[0], q[1], q[2]};
}
[[nodiscard]] inline Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
/// The turn of a rotation vector, and the rotation vector of a unit quaternion by the
/// shorter way: core's, for Eigen.
[[nodiscard]] Eigen::Quaterniond turn_by(const Eigen::Vector3d& vector_rad);
[[nodiscard]] Eigen::Vector3d log_of(Eigen::Quaterniond rotation);

}  // namespace marey::reconstruct
