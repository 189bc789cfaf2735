// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/motion.h"

namespace marey::reconstruct {

/// The coordinates of OpenSim's models of the whole body, by the names and in the order
/// of Rajagopal2016. docs/formats.md says of each which rotation it is and which way it
/// counts.
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

/// OpenSim's name: "hip_flexion_r".
[[nodiscard]] std::string_view name(Coordinate coordinate);

/// The others, pelvis_tx, ty and tz, are lengths.
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
  /// OpenSim's ground is the world, turned about the vertical by this; 0 keeps marker
  /// files, forces and angles in one frame. pelvis_tilt is a tilt forwards and backwards
  /// only of somebody who faces roughly along the ground's X. [rad]
  double ground_yaw_rad = 0.0;
};

/// The joint angles of a motion as OpenSim's Rajagopal2016 defines them (Rajagopal et
/// al., IEEE Trans. Biomed. Eng. 63, 2016), all 0 when standing upright with arms that
/// hang and palms that face forward.
///
/// Each is the rotation of a bone in another, so that no length of the body matters. What
/// a model's joint cannot do, and this skeleton's can, is left out: see docs/formats.md.
///
/// Angles are continuous: they go on beyond 180 degrees rather than jump. The rotation of
/// pelvis, hip, trunk, shoulder or wrist can be told by two triples of angles; of all
/// ways through the motion, that with the smallest steps is taken, and where they do not
/// decide the one nearest to what the model's joints allow. (Some thousand frames far
/// outside count as much as a jump of half a turn, which is then made where it is
/// smallest.) Where the middle angle is 90 degrees to within 1e-6 (gimbal lock; the
/// shoulder's in a T-pose) the other two are not known apart: the first then keeps its
/// last value, or has its next. Near there both are as little known, and a swing of up to
/// 180 degrees in both, between two frames, can be the truth.
///
/// Linear in frames; a few allocations for all of them.
/// Precondition: the skeleton has all 22 bones and identity rest rotations, as
/// make_humanoid() makes it; poses have a unit rotation for every joint; the rate is
/// above 0.
[[nodiscard]] JointAngles joint_angles(const Motion& motion,
                                       const JointAngleOptions& options = {});

/// The quarter turns [rad] about the vertical after which the person of this motion faces
/// most nearly along the ground's X: for JointAngleOptions::ground_yaw_rad.
/// Precondition: as joint_angles().
[[nodiscard]] double yaw_to_face_x_rad(const Motion& motion);

}  // namespace marey::reconstruct
