// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/human/average_proportions.h"

#include "core/base/assert.h"

namespace marey {

Proportions average_proportions(double stature_m) {
  MAREY_ASSERT(stature_m > 0.0);
  using B = HumanBone;
  // Fractions of stature. Winter's figure gives hip height 0.530, knee 0.285, ankle
  // 0.039, shoulder 0.818, upper arm 0.186, forearm 0.146, hand 0.108, foot 0.152, hip
  // breadth 0.191, shoulder breadth 0.259. The hip joint centres lie well inside the hip
  // breadth. The distribution of the trunk over the vertebrae is set by hand.
  Proportions p;
  p[B::kHips] = {0, 0.540, 0};
  p[B::kSpine] = {0, 0.050, 0};
  p[B::kChest] = {0, 0.075, 0};
  p[B::kUpperChest] = {0, 0.080, 0};
  p[B::kNeck] = {0, 0.085, 0};
  p[B::kHead] = {0, 0.055, 0.005};
  p[B::kLeftShoulder] = {0.015, 0.050, 0};
  p[B::kLeftUpperArm] = {0.090, 0, 0};
  p[B::kLeftLowerArm] = {0.186, 0, 0};
  p[B::kLeftHand] = {0.146, 0, 0};
  p[B::kLeftUpperLeg] = {0.052, -0.010, 0};
  p[B::kLeftLowerLeg] = {0, -0.245, 0};
  p[B::kLeftFoot] = {0, -0.246, 0};
  p[B::kLeftToes] = {0, -0.027, 0.080};
  p.head_top_in_head = {0, 0.115, 0};
  p.left_hand_tip_in_hand = {0.108, 0, 0};
  p.left_toe_tip_in_toes = {0, 0, 0.040};
  const auto to_right = [](glm::dvec3 v) { return glm::dvec3(-v.x, v.y, v.z); };
  for (const B bone : human_bones()) {
    if (index(mirrored(bone)) > index(bone)) p[mirrored(bone)] = to_right(p[bone]);
  }
  p.right_hand_tip_in_hand = to_right(p.left_hand_tip_in_hand);
  p.right_toe_tip_in_toes = to_right(p.left_toe_tip_in_toes);

  for (glm::dvec3& offset : p.offset_in_parent) offset *= stature_m;
  for (glm::dvec3* tip : {&p.head_top_in_head,
                          &p.left_hand_tip_in_hand,
                          &p.right_hand_tip_in_hand,
                          &p.left_toe_tip_in_toes,
                          &p.right_toe_tip_in_toes}) {
    *tip *= stature_m;
  }
  return p;
}

}  // namespace marey
