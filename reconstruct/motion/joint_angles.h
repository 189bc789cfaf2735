// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/motion.h"

namespace marey::reconstruct {

/// The coordinates of OpenSim's models of the whole body, by the names and in the order
/// of Rajagopal2016. docs/formats/joint_angles.md defines the rotation and the sign of
/// each.
enum class Coordinate : int {
  kPelvisTilt,
  kPelvisList,
  kPelvisRotation,
  kPelvisTx,
  kPelvisTy,
  kPelvisTz,
  kHipFlexionRight,
  kHipAdductionRight,
  kHipRotationRight,
  kKneeRight,
  kAnkleRight,
  kSubtalarRight,
  kToesRight,
  kHipFlexionLeft,
  kHipAdductionLeft,
  kHipRotationLeft,
  kKneeLeft,
  kAnkleLeft,
  kSubtalarLeft,
  kToesLeft,
  kLumbarExtension,
  kLumbarBending,
  kLumbarRotation,
  kArmFlexionRight,
  kArmAdductionRight,
  kArmRotationRight,
  kElbowRight,
  kPronationRight,
  kWristFlexionRight,
  kWristDeviationRight,
  kArmFlexionLeft,
  kArmAdductionLeft,
  kArmRotationLeft,
  kElbowLeft,
  kPronationLeft,
  kWristFlexionLeft,
  kWristDeviationLeft,
};
inline constexpr std::size_t kCoordinateCount = 37;

[[nodiscard]] constexpr std::size_t index(Coordinate coordinate) {
  return static_cast<std::size_t>(coordinate);
}

/// Returns OpenSim's name: "hip_flexion_r".
[[nodiscard]] std::string_view name(Coordinate coordinate);

/// Returns false for pelvis_tx, ty and tz, which are lengths.
[[nodiscard]] bool is_angle(Coordinate coordinate);

/// The coordinates of every frame of a motion.
struct JointAngles {
  std::vector<double> time_s;  ///< (first_frame + i) / rate.
  std::vector<double> values;  ///< Frame by frame, in the coordinates' order. [rad], [m]

  [[nodiscard]] double at(std::size_t frame, Coordinate coordinate) const {
    return values[frame * kCoordinateCount + index(coordinate)];
  }
};

struct JointAngleOptions {
  /// Rotation of OpenSim's ground relative to the world, about the vertical; 0 keeps
  /// marker files, forces and angles in one frame. pelvis_tilt is a tilt forwards and
  /// backwards only for a person who faces roughly along the ground's X. [rad]
  double ground_yaw_rad = 0.0;
};

/// Computes the joint angles of a motion as OpenSim's Rajagopal2016 defines them
/// (Rajagopal et al., IEEE Trans. Biomed. Eng. 63, 2016), all 0 for upright standing with
/// hanging arms and palms that face forward.
/// Each is the rotation of a bone relative to another, so that lengths of the body have
/// no effect. Rotations of this skeleton that a model's joint does not have are left out:
/// see docs/formats/joint_angles.md.
/// Angles are continuous: they exceed 180 degrees rather than jump. Two triples of angles
/// describe each rotation of pelvis, hip, trunk, shoulder or wrist. The sequence of
/// triples with the smallest steps is chosen, and for equal steps the one nearest to the
/// ranges of the model's joints. (Some thousand frames far outside these ranges have the
/// cost of a jump of half a turn, which is then made where it is smallest.) If the middle
/// angle is 90 degrees to within 1e-6 (gimbal lock; the shoulder's in a T-pose), only a
/// combination of the other two is determined: the first then keeps its last value, or
/// has its next. Near gimbal lock both are poorly determined, and a swing of up to 180
/// degrees in both, between two frames, can be correct.
/// Linear in frames; a few allocations for all of them. Precondition: the skeleton has
/// all 22 bones and identity rest rotations, as from make_humanoid(); poses have a unit
/// rotation for every joint; the rate is above 0.
[[nodiscard]] JointAngles joint_angles(const Motion& motion,
                                       const JointAngleOptions& options = {});

/// Returns the quarter turns [rad] about the vertical after which the person of this
/// motion faces most nearly along the ground's X: for JointAngleOptions::ground_yaw_rad.
/// Precondition: as joint_angles().
[[nodiscard]] double yaw_to_face_x_rad(const Motion& motion);

}  // namespace marey::reconstruct
