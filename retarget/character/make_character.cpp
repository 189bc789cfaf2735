// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/character/make_character.h"

#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "retarget/body/place_masses.h"
#include "retarget/character/check_character.h"
#include "retarget/character/check_groups.h"
#include "retarget/character/joint_limits.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

BodyGroup group_of(std::string name, int level) {
  BodyGroup group;
  group.name = std::move(name);
  group.level = level;
  return group;
}

void add_segment(const BodyMap& map, B bone, BodyGroup& group) {
  const auto joint = map.joint_of[index(bone)];
  if (joint) group.parts.push_back({PartKind::kSegment, {*joint}});
}

void add_limb(const BodyMap& map, std::size_t which, BodyGroup& group) {
  const HumanLimb& bones = human_limbs()[which];
  if (!map.limbs[which]) {
    add_segment(map, bones.lower, group);
    add_segment(map, bones.upper, group);
    return;
  }
  const LimbMap& limb = *map.limbs[which];
  const glm::dquat& t_pose_from_upper = map.joints[index(limb.upper)].t_pose_from_joint;
  group.parts.push_back({PartKind::kLimb,
                         {limb.upper, limb.lower, limb.end},
                         glm::conjugate(t_pose_from_upper) * limb.hinge_in_t_pose});
}

BodyGroup head_group(const BodyMap& map) {
  BodyGroup head = group_of("head", 3);
  head.balances = false;
  add_segment(map, B::kHead, head);
  add_segment(map, B::kNeck, head);
  return head;
}

BodyGroup arm_group(const BodyMap& map, bool left) {
  BodyGroup arm = group_of(left ? "left arm" : "right arm", 3);
  add_segment(map, left ? B::kLeftHand : B::kRightHand, arm);
  add_limb(map, left ? 0 : 1, arm);
  add_segment(map, left ? B::kLeftShoulder : B::kRightShoulder, arm);
  return arm;
}

BodyGroup leg_group(const BodyMap& map, bool left) {
  BodyGroup leg = group_of(left ? "left leg" : "right leg", 2);
  leg.can_support = true;
  add_segment(map, left ? B::kLeftToes : B::kRightToes, leg);
  add_segment(map, left ? B::kLeftFoot : B::kRightFoot, leg);
  add_limb(map, left ? 2 : 3, leg);
  return leg;
}

BodyGroup trunk_group(const BodyMap& map) {
  BodyGroup trunk = group_of("trunk", 2);
  for (const SpineSection* section : {&map.abdomen, &map.torso}) {
    if (section->count == 0) continue;
    const auto* first = section->joints.data();
    trunk.parts.push_back({PartKind::kSection, {first, first + section->count}});
  }
  return trunk;
}

std::vector<BodyGroup> human_groups(const BodyMap& map) {
  std::vector<BodyGroup> groups;
  for (BodyGroup& group : std::vector<BodyGroup>{head_group(map),
                                                 arm_group(map, false),
                                                 arm_group(map, true),
                                                 leg_group(map, false),
                                                 leg_group(map, true),
                                                 trunk_group(map)}) {
    if (!group.parts.empty()) groups.push_back(std::move(group));
  }
  const int root = static_cast<int>(groups.size());
  const bool has_trunk = groups.back().name == "trunk";
  for (BodyGroup& group : groups) {
    if (!has_trunk) group.level = 2;
    group.parent = group.level == 2 ? root : root - 1;
  }
  BodyGroup hips = group_of("root", 1);
  add_segment(map, B::kHips, hips);
  groups.push_back(std::move(hips));
  return groups;
}

// Joints that BodyMap does not drive keep their rotation in their parent.
std::vector<glm::dquat> t_pose(const Skeleton& skeleton, const BodyMap& map) {
  std::vector<glm::dquat> t_pose_from_joint;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    if (map.joints[i].role != JointRole::kFree) {
      t_pose_from_joint.push_back(map.joints[i].t_pose_from_joint);
    } else if (joint.parent) {
      t_pose_from_joint.push_back(glm::normalize(t_pose_from_joint[index(*joint.parent)] *
                                                 joint.parent_from_joint.rotation));
    } else {
      t_pose_from_joint.push_back(joint.parent_from_joint.rotation);
    }
  }
  return t_pose_from_joint;
}

std::optional<JointIndex> joint_of(const Skeleton& skeleton, const std::string& segment) {
  const auto bone = human_bone(segment);
  const auto joint = bone ? skeleton.find(*bone) : std::nullopt;
  return joint ? joint : skeleton.find(segment);
}

Result<Load> load_of(const Character& character, const LoadSpec& spec) {
  const auto joint = joint_of(character.skeleton, spec.point.segment);
  if (!joint) {
    return bad_input("load " + in_quotes(spec.name),
                     "the skeleton has no segment " + in_quotes(spec.point.segment),
                     bone_suggestion(spec.point.segment));
  }
  const glm::dquat& t_pose_from_joint = character.t_pose_from_joint[index(*joint)];
  return Load{spec.name,
              {*joint,
               glm::conjugate(t_pose_from_joint) * spec.point.offset_in_t_pose,
               spec.mass_kg}};
}

}  // namespace

Result<Character> make_character(std::string name,
                                 Skeleton skeleton,
                                 const BodyMap& map,
                                 const CharacterTraits& traits) {
  Character character;
  character.name = std::move(name);
  character.skeleton = std::move(skeleton);
  character.t_pose_from_joint = t_pose(character.skeleton, map);
  character.groups = human_groups(map);
  character.limits = joint_limits(map, traits);
  for (JointLimit& limit : character.limits) {
    limit.t_pose_from_joint = character.t_pose_from_joint[index(limit.joint)];
  }
  character.flexibility = traits.flexibility;
  auto masses = place_masses(character.skeleton, map, traits.mass);
  if (!masses) return masses.error();
  character.masses = *std::move(masses);
  for (const LoadSpec& spec : traits.loads) {
    auto load = load_of(character, spec);
    if (!load) return load.error();
    character.loads.push_back(*std::move(load));
  }
  if (const Status checked = check_character(character); !checked) {
    return checked.error();
  }
  return character;
}

}  // namespace marey::retarget
