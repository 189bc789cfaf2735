// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/soft_tissue.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace marey::reconstruct {
namespace {

using B = HumanBone;

// A marker's centre is 8 mm above the skin, on a base or a suit up to 20. [m]
constexpr double kAboveSkin_m = 0.02;

/// Start and end of a bone's soft tissue in the bone's frame, and its thickness there in
/// shares of stature.
struct Capsule {
  glm::dvec3 a{0.0};
  glm::dvec3 b{0.0};
  double radius_per_stature = 0.0;
};

Capsule capsule_of(HumanBone bone, const Proportions& p) {
  const glm::dvec3 here(0.0);
  switch (bone) {
    case B::kHips:
      return {p[B::kLeftUpperLeg], p[B::kRightUpperLeg] + p[B::kSpine], 0.115};
    case B::kSpine:
      return {here, p[B::kChest], 0.110};
    case B::kChest:
      return {here, p[B::kUpperChest], 0.115};
    case B::kUpperChest:
      return {here, p[B::kNeck], 0.120};
    case B::kNeck:
      return {here, p[B::kHead], 0.060};
    case B::kHead:
      return {here, p.head_top_in_head, 0.075};
    case B::kLeftShoulder:
      return {here, p[B::kLeftUpperArm], 0.075};
    case B::kRightShoulder:
      return {here, p[B::kRightUpperArm], 0.075};
    case B::kLeftUpperArm:
      return {here, p[B::kLeftLowerArm], 0.050};
    case B::kRightUpperArm:
      return {here, p[B::kRightLowerArm], 0.050};
    case B::kLeftLowerArm:
      return {here, p[B::kLeftHand], 0.040};
    case B::kRightLowerArm:
      return {here, p[B::kRightHand], 0.040};
    case B::kLeftHand:
      return {here, p.left_hand_tip_in_hand, 0.040};
    case B::kRightHand:
      return {here, p.right_hand_tip_in_hand, 0.040};
    case B::kLeftUpperLeg:
      return {here, p[B::kLeftLowerLeg], 0.075};
    case B::kRightUpperLeg:
      return {here, p[B::kRightLowerLeg], 0.075};
    case B::kLeftLowerLeg:
      return {here, p[B::kLeftFoot], 0.055};
    case B::kRightLowerLeg:
      return {here, p[B::kRightFoot], 0.055};
    case B::kLeftFoot:
      return {here, p[B::kLeftToes] + p.left_toe_tip_in_toes, 0.050};
    case B::kRightFoot:
      return {here, p[B::kRightToes] + p.right_toe_tip_in_toes, 0.050};
    case B::kLeftToes:
      return {here, p.left_toe_tip_in_toes, 0.040};
    case B::kRightToes:
      return {here, p.right_toe_tip_in_toes, 0.040};
  }
  return {};
}

}  // namespace

double outside_soft_tissue_m(HumanBone bone,
                             const glm::dvec3& p_in_bone,
                             const Proportions& proportions,
                             double stature_m) {
  const Capsule capsule = capsule_of(bone, proportions);
  const glm::dvec3 along = capsule.b - capsule.a;
  const double squared = glm::dot(along, along);
  const double share =
      squared > 0.0
          ? std::clamp(glm::dot(p_in_bone - capsule.a, along) / squared, 0.0, 1.0)
          : 0.0;
  const double off_m = glm::distance(p_in_bone, capsule.a + share * along);
  return std::max(0.0, off_m - capsule.radius_per_stature * stature_m - kAboveSkin_m);
}

}  // namespace marey::reconstruct
