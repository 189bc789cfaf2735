// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/identify_bones.h"

#include <algorithm>
#include <utility>

#include "retarget/bones/bone_names.h"
#include "retarget/bones/bone_shape.h"
#include "retarget/bones/check_bones.h"
#include "retarget/bones/complete_bones.h"
#include "retarget/bones/joint_words.h"
#include "retarget/bones/skeleton_tree.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr std::array kNeeded{B::kLeftUpperLeg,
                             B::kLeftLowerLeg,
                             B::kLeftFoot,
                             B::kRightUpperLeg,
                             B::kRightLowerLeg,
                             B::kRightFoot};

bool has_legs(const FoundBones& found) {
  return std::ranges::all_of(kNeeded,
                             [&](B bone) { return found.joint(bone).has_value(); });
}

/// Returns the marks of a skeleton, of any number.
Result<FoundBones> marked_bones(const SkeletonTree& tree) {
  FoundBones found;
  bool named_alike = true;
  const auto& joints = tree.skeleton().joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].bone) continue;
    const JointIndex joint{static_cast<int>(i)};
    auto& bone = found.bones[index(*joints[i].bone)];
    if (bone) {
      return bad_input("skeleton",
                       "two joints are marked " + std::string(name(*joints[i].bone)) +
                           ": " + tree.quoted(bone->joint) + " and " + tree.quoted(joint),
                       "mark only one of them");
    }
    bone = FoundBone{joint, BoneEvidence::kFile, 1.0};
    named_alike = named_alike && joints[i].name == name(*joints[i].bone);
  }
  found.scheme = "VRM";
  if (!named_alike) return found;
  for (auto& bone : found.bones) {
    if (bone) bone->evidence = BoneEvidence::kName;
  }
  return found;
}

FoundBones named_bones(const NamedBones& named) {
  FoundBones found;
  found.scheme = named.scheme;
  for (const B bone : human_bones()) {
    const auto joint = named.joints[index(bone)];
    if (joint) found.bones[index(bone)] = FoundBone{*joint, BoneEvidence::kName, 0.95};
  }
  return found;
}

void apply_overrides(const BoneMap& overrides, FoundBones& found) {
  for (const B bone : human_bones()) {
    const BoneOverride& entry = overrides.bones[index(bone)];
    if (!entry.is_set) continue;
    auto& slot = found.bones[index(bone)];
    slot.reset();
    if (!entry.joint) continue;
    // The joint is no other bone.
    for (auto& other : found.bones) {
      if (other && other->joint == *entry.joint) other.reset();
    }
    slot = FoundBone{*entry.joint, BoneEvidence::kUser, 1.0};
  }
}

/// Returns true if thighs and shins are found. Feet may follow from them.
bool has_long_bones(const FoundBones& found) {
  return found.joint(B::kLeftUpperLeg) && found.joint(B::kLeftLowerLeg) &&
         found.joint(B::kRightUpperLeg) && found.joint(B::kRightLowerLeg);
}

void remark_missing(FoundBones& found) {
  std::string missing;
  for (const HumanLimb& limb : human_limbs()) {
    for (const B bone : {limb.upper, limb.lower, limb.end}) {
      if (found.joint(bone)) continue;
      missing += (missing.empty() ? "" : ", ") + std::string(name(bone));
    }
  }
  if (!found.joint(B::kHead)) missing += missing.empty() ? "head" : ", head";
  if (!missing.empty()) found.remarks.push_back("no joint was found for " + missing);
}

}  // namespace

FoundBones guess_bones(const Skeleton& skeleton, const BoneMap& overrides) {
  FoundBones found;
  if (skeleton.joints.empty()) return found;
  const SkeletonTree tree(skeleton);
  if (const auto named = name_bones(tree)) found = named_bones(*named);
  apply_overrides(overrides, found);
  if (!found.joint(B::kLeftUpperLeg) || !found.joint(B::kRightUpperLeg)) {
    if (auto shape = shape_bones(tree)) found = *std::move(shape);
    apply_overrides(overrides, found);
  }
  const BoneOverride& hips = overrides.bones[index(B::kHips)];
  const bool can_complete = found.joint(B::kLeftUpperLeg) &&
                            found.joint(B::kRightUpperLeg) &&
                            (!hips.is_set || hips.joint);
  if (can_complete) complete_bones(tree, joint_words(skeleton), overrides, found);
  return found;
}

Result<FoundBones> identify_bones(const Skeleton& skeleton, const BoneMap& overrides) {
  if (skeleton.joints.empty()) {
    return bad_input("skeleton", "it has no joints", "use a file with a skeleton");
  }
  const SkeletonTree tree(skeleton);
  auto found = marked_bones(tree);
  if (!found) return found.error();
  const bool is_marked = has_legs(*found) && found->joint(B::kHips);
  const std::vector<JointWord> words = joint_words(skeleton);
  if (!is_marked) {
    const auto named = name_bones(tree);
    if (!named) return named.error();
    found = named_bones(*named);
  }
  apply_overrides(overrides, *found);
  if (!has_long_bones(*found)) {
    auto shape = shape_bones(tree);
    // If names explain most of a body, the missing names are the better error.
    const bool is_named = found->joint(B::kHips) && found->joint(B::kLeftUpperLeg) &&
                          found->joint(B::kRightUpperLeg);
    if (!shape && is_named) return check_bones(tree, overrides, *found).error();
    if (!shape) return shape.error();
    found = std::move(shape);
    apply_overrides(overrides, *found);
  }
  // Bones cannot be completed without the hips.
  const BoneOverride& hips_override = overrides.bones[index(B::kHips)];
  const bool can_complete = found->joint(B::kLeftUpperLeg) &&
                            found->joint(B::kRightUpperLeg) &&
                            (!hips_override.is_set || hips_override.joint);
  if (!is_marked && can_complete) complete_bones(tree, words, overrides, *found);
  if (const Status ok = check_bones(tree, overrides, *found); !ok) return ok.error();
  remark_missing(*found);
  return found;
}

void mark(const FoundBones& found, Skeleton& skeleton) {
  for (Joint& joint : skeleton.joints) joint.bone.reset();
  for (const B bone : human_bones()) {
    if (const auto joint = found.joint(bone)) {
      skeleton.joints[index(*joint)].bone = bone;
    }
  }
}

}  // namespace marey::retarget
