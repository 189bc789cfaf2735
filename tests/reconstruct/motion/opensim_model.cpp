// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/reconstruct/motion/opensim_model.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/assert.h"
#include "tests/support/truth/rotation_of_axes.h"

namespace marey::testing {
namespace {

using B = HumanBone;
using reconstruct::Coordinate;

const glm::dvec3 kX{1, 0, 0};
const glm::dvec3 kY{0, 1, 0};
const glm::dvec3 kZ{0, 0, 1};

glm::dquat about(const glm::dvec3& axis, double angle_rad) {
  return glm::angleAxis(angle_rad, glm::normalize(axis));
}

/// OpenSim's X, Y, Z are this skeleton's Z, Y, -X.
const glm::dquat kAxes = rotation_of_axes(kZ, kY, kX, kY);

}  // namespace

Coordinate coordinate(const std::string& name) {
  int i = 0;
  while (reconstruct::name(Coordinate{i}) != name) {
    ++i;
    MAREY_ASSERT(i < static_cast<int>(reconstruct::kCoordinateCount));
  }
  return Coordinate{i};
}

Model::Model(const Angles& angles) : angles_(angles) {
  pelvis_ = ball({"pelvis_tilt", "pelvis_list", "pelvis_rotation"}, 1.0);
  const glm::dquat torso =
      pelvis_ * ball({"lumbar_extension", "lumbar_bending", "lumbar_rotation"}, 1.0);
  for (const B bone : human_bones()) put(bone, torso * kAxes);
  put(B::kHips, pelvis_ * kAxes);
  put(B::kSpine, pelvis_ * kAxes);
  for (const bool left : {false, true}) {
    leg(left);
    arm(torso, left);
  }
}

double Model::of(const std::string& name) const {
  return angles_[index(coordinate(name))];
}

glm::dquat Model::ball(const std::array<std::string, 3>& names, double side) const {
  return about(kZ, of(names[0])) * about(side * kX, of(names[1])) *
         about(side * kY, of(names[2]));
}

void Model::put(B bone, const glm::dquat& world_from_bone) {
  world_from_bone_[index(bone)] = world_from_bone;
}

void Model::leg(bool left) {
  const std::string s = left ? "_l" : "_r";
  const double side = left ? -1.0 : 1.0;
  const glm::dquat thigh =
      pelvis_ * ball({"hip_flexion" + s, "hip_adduction" + s, "hip_rotation" + s}, side);
  const glm::dquat shank = thigh * about(-kZ, of("knee_angle" + s));
  const glm::dvec3 ankle(-0.10501355 * side, -0.17402245 * side, 0.97912632);
  const glm::dvec3 subtalar(0.78717961 * side, 0.60474746 * side, -0.12094949);
  const glm::dvec3 mtp(0.58095440 * side, 0.0, -0.81393611);
  const glm::dquat foot = shank * about(ankle, of("ankle_angle" + s)) *
                          about(subtalar, of("subtalar_angle" + s));
  put(left ? B::kLeftUpperLeg : B::kRightUpperLeg, thigh * kAxes);
  put(left ? B::kLeftLowerLeg : B::kRightLowerLeg, shank * kAxes);
  put(left ? B::kLeftFoot : B::kRightFoot, foot * kAxes);
  put(left ? B::kLeftToes : B::kRightToes,
      foot * about(mtp, of("mtp_angle" + s)) * kAxes);
}

void Model::arm(const glm::dquat& torso, bool left) {
  const std::string s = left ? "_l" : "_r";
  const double side = left ? -1.0 : 1.0;
  const glm::dquat upper =
      torso * ball({"arm_flex" + s, "arm_add" + s, "arm_rot" + s}, side);
  const glm::dvec3 elbow(0.22604696 * side, 0.0, 0.97386183);
  const glm::dquat ulna = upper * about(elbow, of("elbow_flex" + s));
  const auto radius = [&](double share) {
    return ulna * about(side * kY, share * of("pro_sup" + s));
  };
  const glm::dquat hand = radius(1.0) * about(kZ, of("wrist_flex" + s)) *
                          about(side * kX, of("wrist_dev" + s));
  // In the T-pose an arm points to its side, palm down, and the elbow bends about the
  // vertical; at zero it hangs, palm to the front.
  const glm::dvec3 out = -side * kX;
  const glm::dquat upper_at_zero =
      rotation_of_axes(out, side * kY, -kY, glm::normalize(elbow));
  const glm::dquat hand_at_zero = rotation_of_axes(out, -kY, -kY, kX);
  put(left ? B::kLeftUpperArm : B::kRightUpperArm, upper * upper_at_zero);
  put(left ? B::kLeftLowerArm : B::kRightLowerArm, radius(0.4) * hand_at_zero);
  put(left ? B::kLeftHand : B::kRightHand, hand * hand_at_zero);
}

}  // namespace marey::testing
