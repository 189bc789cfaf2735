// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/library/library_motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Path of one marked bone over a motion. Empty without the bone.
struct BonePath {
  JointIndex joint{};
  std::vector<glm::dvec3> p_in_world;  ///< Place of the joint. [m]
  /// Rotation relative to the T-pose, in the world.
  std::vector<glm::dquat> world_from_t_pose;
  /// Angle of the rotation in the parent from the frame before; 0 in the first. [rad]
  std::vector<double> step_rad;

  [[nodiscard]] bool empty() const { return p_in_world.empty(); }
};

/// Quantities of all frames that several figures use: forward kinematics, computed once.
struct QualityFrames {
  int count = 0;
  double hz = 0.0;
  double leg_m = 0.0;
  std::array<BonePath, kHumanBoneCount> bones;
  std::vector<glm::dvec3> com_in_world;  ///< Centre of mass. [m]
  /// Depth of each hand's joint in the surface of the trunk or the head; 0 outside.
  /// [side][frame], empty without the hand.
  std::array<std::vector<double>, 2> hand_depth_m;
  /// Height of the lowest point of each sole, [side][frame]. [m]
  std::array<std::vector<double>, 2> sole_m;
  /// Ball of each foot, [side][frame]; the estimate of the map without toes. [m]
  std::array<std::vector<glm::dvec3>, 2> ball_in_world;

  [[nodiscard]] const BonePath& operator[](HumanBone bone) const {
    return bones[marey::index(bone)];
  }
};

/// Computes them. Linear in frames times joints; about 350 bytes per marked bone and
/// frame.
/// Precondition: `map` was made from the motion's skeleton.
[[nodiscard]] QualityFrames quality_frames(const Motion& motion,
                                           const retarget::BodyMap& map);

/// Returns the toes' bone of a side, 0 left and 1 right.
[[nodiscard]] constexpr HumanBone toes_of(int side) {
  return side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
}
/// Returns the foot's bone of a side, 0 left and 1 right.
[[nodiscard]] constexpr HumanBone foot_of(int side) {
  return side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
}

/// Returns quantile() of core/base/quantile.h of values that may be reordered, without an
/// allocation. 0 without values.
[[nodiscard]] double quantile_in_place(std::span<double> values, double share);

}  // namespace marey::library
