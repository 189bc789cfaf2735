// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/identify_bones.h"

#include <algorithm>
#include <utility>

#include "retarget/bone_names.h"
#include "retarget/bone_shape.h"
#include "retarget/complete_bones.h"
#include "retarget/skeleton_tree.h"

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

/// The marks of a skeleton, however many.
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

void put_told(const BoneMap& told, FoundBones& found) {
  for (const B bone : human_bones()) {
    const ToldBone& said = told.bones[index(bone)];
    if (!said.told) continue;
    auto& slot = found.bones[index(bone)];
    slot.reset();
    if (!said.joint) continue;
    // Whatever else the joint was taken for, it is not.
    for (auto& other : found.bones) {
      if (other && other->joint == *said.joint) other.reset();
    }
    slot = FoundBone{*said.joint, BoneEvidence::kTold, 1.0};
  }
}

/// Feet may follow from what they hang on.
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

std::string_view name(BoneEvidence evidence) {
  switch (evidence) {
    case BoneEvidence::kFile:
      return "file";
    case BoneEvidence::kTold:
      return "told";
    case BoneEvidence::kName:
      return "name";
    case BoneEvidence::kChain:
      return "chain";
    case BoneEvidence::kShape:
      return "shape";
  }
  return "";
}

FoundBones guess_bones(const Skeleton& skeleton, const BoneMap& told) {
  FoundBones found;
  if (skeleton.joints.empty()) return found;
  const SkeletonTree tree(skeleton);
  if (const auto named = name_bones(tree)) found = named_bones(*named);
  put_told(told, found);
  if (!found.joint(B::kLeftUpperLeg) || !found.joint(B::kRightUpperLeg)) {
    if (auto shape = shape_bones(tree)) found = *std::move(shape);
    put_told(told, found);
  }
  const ToldBone& hips = told.bones[index(B::kHips)];
  const bool can_complete = found.joint(B::kLeftUpperLeg) &&
                            found.joint(B::kRightUpperLeg) && (!hips.told || hips.joint);
  if (can_complete) complete_bones(tree, joint_words(skeleton), told, found);
  return found;
}

Result<FoundBones> identify_bones(const Skeleton& skeleton, const BoneMap& told) {
  if (skeleton.joints.empty()) {
    return bad_input("skeleton", "it has no joints", "give a file with a skeleton");
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
  put_told(told, *found);
  if (!has_long_bones(*found)) {
    auto shape = shape_bones(tree);
    // Where names say most of a body, what they lack is the better reason.
    const bool is_named = found->joint(B::kHips) && found->joint(B::kLeftUpperLeg) &&
                          found->joint(B::kRightUpperLeg);
    if (!shape && is_named) return check_bones(tree, told, *found).error();
    if (!shape) return shape.error();
    found = std::move(shape);
    put_told(told, *found);
  }
  // What a map leaves out cannot be completed from.
  const ToldBone& told_hips = told.bones[index(B::kHips)];
  const bool can_complete = found->joint(B::kLeftUpperLeg) &&
                            found->joint(B::kRightUpperLeg) &&
                            (!told_hips.told || told_hips.joint);
  if (!is_marked && can_complete) complete_bones(tree, words, told, *found);
  if (const Status ok = check_bones(tree, told, *found); !ok) return ok.error();
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
