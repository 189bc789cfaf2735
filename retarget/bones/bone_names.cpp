// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/bone_names.h"

#include <algorithm>

#include "retarget/bones/joint_words.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

/// The words of a scheme for each bone it names, the left one's for both sides. If there
/// are several words, the first one present is used.
struct Scheme {
  std::string_view name;
  std::string_view hips;
  std::string_view neck;
  std::string_view head;
  std::string_view shoulder;
  std::string_view upper_arm;
  std::string_view lower_arm;
  std::string_view hand;
  std::string_view upper_leg;
  std::string_view lower_leg;
  std::string_view foot;
  std::string_view toes;
};

// The order decides between schemes that explain the same number of bones.
constexpr std::array<Scheme, 12> kSchemes{{
    {"Mixamo, MotionBuilder, LaFAN",
     "hips hip",
     "neck",
     "head",
     "shoulder",
     "arm",
     "forearm",
     "hand",
     "upleg",
     "leg",
     "foot",
     "toebase toe toes"},
    {"Unreal",
     "pelvis",
     "neck1 neck",
     "head",
     "clavicle",
     "upperarm",
     "lowerarm",
     "hand",
     "thigh",
     "calf",
     "foot",
     "ball"},
    {"VRM, Unity, Bandai, KayKit",
     "hips hip",
     "neck",
     "head headm",
     "shoulder",
     "upperarm",
     "lowerarm",
     "wrist hand palm palm2",
     "upperleg",
     "lowerleg",
     "foot",
     "toes toe toebase"},
    {"3ds Max biped",
     "pelvis",
     "neck",
     "head",
     "clavicle",
     "upperarm",
     "forearm",
     "hand",
     "thigh",
     "calf",
     "foot",
     "toe0 toe toebase"},
    {"Rigify",
     "spine hips",
     "spine4 neck",
     "spine6 head",
     "shoulder",
     "upperarm",
     "forearm",
     "hand",
     "thigh",
     "shin",
     "foot",
     "toe"},
    {"CMU Acclaim",
     "root hips",
     "lowerneck",
     "head",
     "clavicle",
     "humerus",
     "radius",
     "wrist",
     "femur",
     "tibia",
     "foot",
     "toes"},
    {"H-Anim",
     "root humanoidroot sacroiliac",
     "vc7 vc6 vc5 vc4",
     "skullbase skull head",
     "sternoclavicular",
     "shoulder",
     "elbow",
     "wrist radiocarpal",
     "hip",
     "knee",
     "ankle talocrural",
     "midtarsal metatarsal metatarsophalangeal"},
    {"joints (hip, knee, ankle)",
     "hips pelvis hip root",
     "neck",
     "head",
     "collar clavicle sternoclavicular",
     "shoulder",
     "elbow",
     "wrist",
     "hip",
     "knee",
     "ankle",
     "toe toes ball foot"},
    {"VRChat",
     "hips",
     "neck",
     "head",
     "shoulder",
     "arm",
     "elbow",
     "wrist",
     "leg",
     "knee",
     "ankle",
     "toe toes"},
    {"Daz",
     "hip pelvis",
     "necklower neck",
     "head",
     "collar",
     "shldrbend shldr",
     "forearmbend forearm",
     "hand",
     "thighbend thigh",
     "shin",
     "foot",
     "toe"},
    {"Xsens",
     "pelvis hips",
     "neck",
     "head",
     "shoulder",
     "upperarm",
     "forearm",
     "hand",
     "upperleg",
     "lowerleg",
     "foot",
     "toe toes"},
    {"common words",
     "hips pelvis hip root",
     "neck neck1",
     "head",
     "clavicle collar shoulder",
     "upperarm uparm humerus bicep arm",
     "lowerarm forearm loarm radius elbow",
     "hand wrist palm",
     "upperleg upleg thigh femur",
     "lowerleg loleg shin calf tibia knee leg",
     "foot ankle",
     "toes toe toebase ball toe0"},
}};

struct SchemeBone {
  B left;
  std::string_view Scheme::*words;
};
constexpr std::array<SchemeBone, 11> kBones{{
    {B::kHips, &Scheme::hips},
    {B::kNeck, &Scheme::neck},
    {B::kHead, &Scheme::head},
    {B::kLeftShoulder, &Scheme::shoulder},
    {B::kLeftUpperArm, &Scheme::upper_arm},
    {B::kLeftLowerArm, &Scheme::lower_arm},
    {B::kLeftHand, &Scheme::hand},
    {B::kLeftUpperLeg, &Scheme::upper_leg},
    {B::kLeftLowerLeg, &Scheme::lower_leg},
    {B::kLeftFoot, &Scheme::foot},
    {B::kLeftToes, &Scheme::toes},
}};

/// Returns the joints whose word is the first of `words` that any joint has.
std::vector<JointIndex> joints_named(const std::vector<JointWord>& names,
                                     std::string_view words,
                                     NameSide side) {
  std::vector<JointIndex> found;
  while (found.empty() && !words.empty()) {
    const std::string_view word = words.substr(0, words.find(' '));
    words.remove_prefix(std::min(words.size(), word.size() + 1));
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].side == side && names[i].word == word) {
        found.push_back(JointIndex{static_cast<int>(i)});
      }
    }
  }
  return found;
}

/// Rigs for animators contain each bone several times: keeps the joints with skin.
void keep_deforming(const Skeleton& skeleton, std::vector<JointIndex>& joints) {
  const auto deforms = [&](JointIndex joint) {
    return skeleton[joint].name.find("DEF") != std::string::npos;
  };
  if (std::ranges::any_of(joints, deforms)) {
    std::erase_if(joints, [&](JointIndex joint) { return !deforms(joint); });
  }
}

struct NamedScheme {
  std::array<std::vector<JointIndex>, kHumanBoneCount> joints;
  int legs = 0;
  int bones = 0;
};

NamedScheme read_scheme(const Skeleton& skeleton,
                        const std::vector<JointWord>& names,
                        const Scheme& scheme) {
  NamedScheme result;
  const auto read = [&](B bone, std::string_view words, NameSide side) {
    auto& joints = result.joints[index(bone)];
    joints = joints_named(names, words, side);
    if (joints.empty()) return;
    keep_deforming(skeleton, joints);
    ++result.bones;
    const bool is_leg =
        bone >= B::kLeftUpperLeg && bone != B::kLeftToes && bone != B::kRightToes;
    if (is_leg) ++result.legs;
  };
  for (const SchemeBone& row : kBones) {
    const std::string_view words = scheme.*row.words;
    if (mirrored(row.left) == row.left) {
      read(row.left, words, NameSide::kNone);
    } else {
      read(row.left, words, NameSide::kLeft);
      read(mirrored(row.left), words, NameSide::kRight);
    }
  }
  return result;
}

std::string below(const SkeletonTree& tree, JointIndex joint) {
  const auto above = tree.parent(joint);
  return above ? " below " + tree.quoted(*above) : "";
}

/// Returns one joint of several of one name: the lowest if they are below each other.
Result<JointIndex> only(const SkeletonTree& tree,
                        B bone,
                        const std::vector<JointIndex>& joints) {
  JointIndex lowest = joints[0];
  for (const JointIndex joint : joints) {
    if (joint == lowest || tree.is_below(lowest, joint)) continue;
    if (tree.is_below(joint, lowest)) {
      lowest = joint;
      continue;
    }
    // A copy of it, of another armature of the same body.
    const double reach = tree.reach(JointIndex{0});
    if (tree.distance(lowest, joint) < 1e-4 * reach) continue;
    return bad_input("skeleton",
                     "two joints have the name of a body's " + std::string(name(bone)) +
                         ": " + tree.quoted(lowest) + below(tree, lowest) + " (joint " +
                         std::to_string(index(lowest)) + ") and " + tree.quoted(joint) +
                         below(tree, joint) + " (joint " + std::to_string(index(joint)) +
                         ")",
                     "use a file with one body, or rename one of the two joints");
  }
  return lowest;
}

/// Returns the name of a scheme that several programs share, for this skeleton.
std::string_view scheme_name(const Skeleton& skeleton,
                             const std::vector<JointWord>& names,
                             const Scheme& scheme) {
  if (&scheme != kSchemes.data()) return scheme.name;
  const auto any_has = [&](std::string_view text) {
    return std::ranges::any_of(skeleton.joints, [&](const Joint& joint) {
      return joint.name.find(text) != std::string::npos;
    });
  };
  const auto has_word = [&](std::string_view word) {
    return std::ranges::any_of(names,
                               [&](const JointWord& name) { return name.word == word; });
  };
  if (any_has("mixamorig")) return "Mixamo";
  if (has_word("hipjoint") || has_word("lowerback")) return "CMU, MotionBuilder";
  return "MotionBuilder, LaFAN";
}

}  // namespace

Result<NamedBones> name_bones(const SkeletonTree& tree) {
  const Skeleton& skeleton = tree.skeleton();
  const std::vector<JointWord> names = joint_words(skeleton);
  NamedScheme best;
  const Scheme* chosen = nullptr;
  for (const Scheme& scheme : kSchemes) {
    NamedScheme read = read_scheme(skeleton, names, scheme);
    const bool is_better =
        read.legs > best.legs || (read.legs == best.legs && read.bones > best.bones);
    if (!is_better) continue;
    best = std::move(read);
    chosen = &scheme;
  }
  NamedBones result;
  if (chosen == nullptr) return result;
  result.scheme = scheme_name(skeleton, names, *chosen);
  result.legs = best.legs;
  for (const HumanBone bone : human_bones()) {
    const auto& joints = best.joints[index(bone)];
    if (joints.empty()) continue;
    const auto joint = only(tree, bone, joints);
    if (!joint) return joint.error();
    result.joints[index(bone)] = *joint;
  }
  return result;
}

}  // namespace marey::retarget
