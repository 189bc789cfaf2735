// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/skeleton.h"

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey {

std::optional<JointIndex> Skeleton::find(HumanBone bone) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].bone == bone) return JointIndex{static_cast<int>(i)};
  }
  return std::nullopt;
}

std::optional<JointIndex> Skeleton::find(std::string_view joint_name) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == joint_name) return JointIndex{static_cast<int>(i)};
  }
  return std::nullopt;
}

Skeleton make_humanoid(const Proportions& proportions) {
  Skeleton skeleton;
  for (const HumanBone bone : human_bones()) {
    Joint joint;
    joint.name = std::string(name(bone));
    joint.bone = bone;
    if (const auto p = parent(bone)) joint.parent = JointIndex{static_cast<int>(*p)};
    joint.parent_from_joint.translation = proportions[bone];
    skeleton.joints.push_back(std::move(joint));
  }
  const auto tip = [&](HumanBone bone) -> std::optional<glm::dvec3>& {
    return skeleton.joints[index(bone)].tip_in_joint;
  };
  tip(HumanBone::kHead) = proportions.head_top_in_head;
  tip(HumanBone::kLeftHand) = proportions.left_hand_tip_in_hand;
  tip(HumanBone::kRightHand) = proportions.right_hand_tip_in_hand;
  tip(HumanBone::kLeftToes) = proportions.left_toe_tip_in_toes;
  tip(HumanBone::kRightToes) = proportions.right_toe_tip_in_toes;
  return skeleton;
}

Proportions proportions_of(const Skeleton& skeleton) {
  Proportions p;
  for (const HumanBone bone : human_bones()) {
    const auto joint = skeleton.find(bone);
    MAREY_ASSERT(joint.has_value());
    p[bone] = skeleton[*joint].parent_from_joint.translation;
  }
  const auto tip = [&](HumanBone bone) {
    return skeleton[*skeleton.find(bone)].tip_in_joint.value_or(glm::dvec3(0.0));
  };
  p.head_top_in_head = tip(HumanBone::kHead);
  p.left_hand_tip_in_hand = tip(HumanBone::kLeftHand);
  p.right_hand_tip_in_hand = tip(HumanBone::kRightHand);
  p.left_toe_tip_in_toes = tip(HumanBone::kLeftToes);
  p.right_toe_tip_in_toes = tip(HumanBone::kRightToes);
  return p;
}

double leg_length_m(const Proportions& p) {
  using B = HumanBone;
  return 0.5 * (glm::length(p[B::kLeftLowerLeg]) + glm::length(p[B::kLeftFoot]) +
                glm::length(p[B::kRightLowerLeg]) + glm::length(p[B::kRightFoot]));
}

}  // namespace marey
