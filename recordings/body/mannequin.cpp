// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/mannequin.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/body/mannequin_figure.h"

namespace marey::recordings {
namespace {

using B = HumanBone;

/// Returns the height of the toe joints relative to the hips' height, the mean of both
/// sides. [m]
double toes_below_hips(const Proportions& p) {
  double sum = 0.0;
  for (const B bone : {B::kLeftUpperLeg,
                       B::kLeftLowerLeg,
                       B::kLeftFoot,
                       B::kLeftToes,
                       B::kRightUpperLeg,
                       B::kRightLowerLeg,
                       B::kRightFoot,
                       B::kRightToes}) {
    sum -= p[bone].y;
  }
  return 0.5 * sum;
}

double top_of_head_m(const Proportions& p) {
  double height = p.head_top_in_head.y;
  for (const B bone :
       {B::kHips, B::kSpine, B::kChest, B::kUpperChest, B::kNeck, B::kHead}) {
    height += p[bone].y;
  }
  return height;
}

void scale_all(Proportions& p, double factor) {
  for (glm::dvec3& offset : p.offset_in_parent) offset *= factor;
  for (glm::dvec3* tip : {&p.head_top_in_head,
                          &p.left_hand_tip_in_hand,
                          &p.right_hand_tip_in_hand,
                          &p.left_toe_tip_in_toes,
                          &p.right_toe_tip_in_toes}) {
    *tip *= factor;
  }
}

}  // namespace

Proportions mannequin_proportions(const MannequinOptions& options) {
  MAREY_ASSERT(options.stature_m > 0.0);
  MAREY_ASSERT(options.arm > 0.0 && options.leg > 0.0 && options.foot > 0.0);
  MAREY_ASSERT(options.trunk > 0.0 && options.head > 0.0);
  MAREY_ASSERT(options.shoulder_width > 0.0 && options.hip_width > 0.0);
  Proportions p = average_proportions(1.0);
  const double toe_height = p[B::kHips].y - toes_below_hips(p);

  const auto both = [&](B left, const glm::dvec3& factor) {
    p[left] *= factor;
    p[mirrored(left)] *= factor;
  };
  both(B::kLeftLowerArm, glm::dvec3(options.arm));
  both(B::kLeftHand, glm::dvec3(options.arm));
  p.left_hand_tip_in_hand *= options.arm;
  p.right_hand_tip_in_hand *= options.arm;
  both(B::kLeftLowerLeg, glm::dvec3(options.leg));
  both(B::kLeftFoot, glm::dvec3(options.leg));
  both(B::kLeftToes, {options.foot, 1.0, options.foot});
  p.left_toe_tip_in_toes *= options.foot;
  p.right_toe_tip_in_toes *= options.foot;
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest, B::kNeck}) {
    p[bone] *= options.trunk;
  }
  p[B::kHead] *= options.head;
  p.head_top_in_head *= options.head;
  both(B::kLeftShoulder, {options.shoulder_width, options.trunk, options.trunk});
  both(B::kLeftUpperArm, glm::dvec3(options.shoulder_width));
  both(B::kLeftUpperLeg, {options.hip_width, 1.0, 1.0});

  p[B::kHips].y = toes_below_hips(p) + toe_height;
  scale_all(p, options.stature_m / top_of_head_m(p));
  return p;
}

namespace {

/// Places every joint and measures the body as a whole.
Figure lay_out(const Proportions& proportions, const MannequinStyle& style) {
  Figure figure{.builder = MeshBuilder({{"body", style.body_colour, 0.55},
                                        {"joints", style.joint_colour, 0.45},
                                        {"front", style.mark_colour, 0.5}}),
                .proportions = proportions};
  const Skeleton skeleton = make_humanoid(proportions);
  const auto world_from_joint = world_from_joints(skeleton, rest_pose(skeleton));
  for (const B bone : human_bones()) {
    figure.p_in_world[index(bone)] = world_from_joint[index(bone)].translation;
  }
  const glm::dvec3 top = world_from_joint[index(B::kHead)] * proportions.head_top_in_head;
  const double toes = 0.5 * (figure.at(B::kLeftToes).y + figure.at(B::kRightToes).y);
  // The toe joints are at 1.2 % of the stature.
  figure.size_m = (top.y - toes) / (1.0 - kToeJointHeight);
  MAREY_ASSERT(figure.size_m > 0.0);
  figure.thickness_m = figure.size_m * style.girth;
  return figure;
}

}  // namespace

SkinnedMesh make_mannequin_mesh(const Proportions& proportions,
                                const MannequinStyle& style) {
  MAREY_ASSERT(style.girth > 0.0);
  Figure figure = lay_out(proportions, style);
  add_trunk(figure);
  add_neck(figure);
  add_head(figure);
  for (const HumanLimb& limb : human_limbs()) {
    if (limb.end == B::kLeftHand || limb.end == B::kRightHand) {
      add_arm(figure, limb);
    } else {
      add_leg(figure, limb);
    }
  }
  add_hand(figure, B::kLeftHand, proportions.left_hand_tip_in_hand);
  add_hand(figure, B::kRightHand, proportions.right_hand_tip_in_hand);
  add_foot(figure, B::kLeftFoot, B::kLeftToes, proportions.left_toe_tip_in_toes);
  add_foot(figure, B::kRightFoot, B::kRightToes, proportions.right_toe_tip_in_toes);
  return std::move(figure.builder.mesh());
}

}  // namespace marey::recordings
