// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/complete_bones.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "retarget/bones/bone_shape.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

// Share of the height from hips to neck of an average chest joint.
constexpr double kChestHeight = 0.43;

struct Completion {
  const SkeletonTree& tree;
  const std::vector<JointWord>& words;
  const BoneMap& overrides;
  FoundBones& found;

  [[nodiscard]] bool by_shape() const {
    const auto& leg = found.bones[index(B::kLeftUpperLeg)];
    return leg && leg->evidence == BoneEvidence::kShape;
  }
  [[nodiscard]] std::string word(JointIndex joint) const {
    return words[index(joint)].word;
  }
  [[nodiscard]] bool is_overridden(B bone) const {
    return overrides.bones[index(bone)].is_set;
  }
  void remark(std::string text) { found.remarks.push_back(std::move(text)); }
  void set(B bone, JointIndex joint, BoneEvidence evidence, double confidence) {
    if (is_overridden(bone)) return;
    if (by_shape()) {
      // A bone that follows from a guess has at max_offset the guess's confidence.
      evidence = BoneEvidence::kShape;
      confidence *= found.bones[index(B::kLeftUpperLeg)]->confidence;
    }
    found.bones[index(bone)] = FoundBone{joint, evidence, confidence};
  }
  void drop(B bone) {
    if (!is_overridden(bone)) found.bones[index(bone)].reset();
  }
};

/// Returns true if a hand or foot with another parent is the end of its limb: the bone
/// itself, moved by inverse kinematics, and not a handle for it.
bool ends_limb(const Completion& c,
               const HumanLimb& limb,
               JointIndex lower,
               JointIndex end,
               const std::vector<JointIndex>& way) {
  constexpr double kNear = 0.2;  // Share of the lower bone.
  if (c.tree.is_below(lower, end)) return false;
  const double length = c.tree.distance(lower, end);
  // The limb itself continues: it has a foot with toes or a hand with fingers.
  if (way.size() > 2) return false;
  if (way.size() == 2) return c.tree.distance(way[1], end) < kNear * length;
  const auto upper = c.found.joint(limb.upper);
  if (!upper) return false;
  const double above = c.tree.distance(*upper, lower);
  return length > 0.5 * above && length < 2.0 * above;
}

/// A hand or foot that controls inverse kinematics is below the root. The limb's own end
/// is the child of its lower bone, or that joint itself.
void find_ends(Completion& c) {
  for (const HumanLimb& limb : human_limbs()) {
    const auto lower = c.found.joint(limb.lower);
    const auto end = c.found.joint(limb.end);
    if (!lower || c.is_overridden(limb.end)) continue;
    if (end && c.tree.is_below(*end, *lower)) continue;
    const std::vector<JointIndex> way = c.tree.longest_path(*lower);
    if (end && ends_limb(c, limb, *lower, *end, way)) {
      c.remark(c.tree.quoted(*end) + ", the " + std::string(name(limb.end)) +
               ", was not below " + c.tree.quoted(*lower) + "; it was moved there");
      continue;
    }
    if (way.size() < 2) continue;
    if (end) {
      c.remark(c.tree.quoted(*end) + " has the name of the " +
               std::string(name(limb.end)) + " but is not below " +
               c.tree.quoted(*lower) + "; " + c.tree.quoted(way[1]) + " is used");
    }
    c.set(limb.end, way[1], BoneEvidence::kChain, 0.6);
  }
}

std::vector<JointIndex> found_of(const FoundBones& found,
                                 std::initializer_list<B> bones) {
  std::vector<JointIndex> joints;
  for (const B bone : bones) {
    if (const auto joint = found.joint(bone)) joints.push_back(*joint);
  }
  return joints;
}

void find_head(Completion& c) {
  if (c.found.joint(B::kHead) || c.is_overridden(B::kHead)) return;
  const auto arms = found_of(c.found, {B::kLeftUpperArm, B::kRightUpperArm});
  if (arms.size() < 2) return;
  const JointIndex chest = c.tree.common(arms);
  const auto head = head_above(c.tree, chest, arms);
  if (head) c.set(B::kHead, *head, BoneEvidence::kChain, 0.6);
}

glm::dvec3 mid_hip(const Completion& c) {
  return 0.5 * (c.tree.place(*c.found.joint(B::kLeftUpperLeg)) +
                c.tree.place(*c.found.joint(B::kRightUpperLeg)));
}

/// Returns half a leg length: hips are nearer than this to the start of the legs.
double half_leg(const Completion& c) {
  const auto upper = c.found.joint(B::kLeftUpperLeg);
  const auto lower = c.found.joint(B::kLeftLowerLeg);
  if (!lower) return 0.5 * c.tree.reach(*upper);
  const auto foot = c.found.joint(B::kLeftFoot);
  const double thigh = c.tree.distance(*upper, *lower);
  return 0.5 * (thigh + (foot ? c.tree.distance(*lower, *foot) : thigh));
}

/// Returns the hips of a body whose legs and spine part at its root on the floor: the
/// joint that carries the spine and is nearest to the start of the legs.
std::optional<JointIndex> hips_of_spine(const Completion& c, JointIndex root) {
  const glm::dvec3 place = mid_hip(c);
  const auto off = [&](JointIndex joint) {
    return glm::distance(c.tree.place(joint), place);
  };
  const double max_offset = half_leg(c);
  const auto named = c.found.joint(B::kHips);
  if (named && off(*named) < max_offset && named != root) return named;
  std::optional<JointIndex> nearest;
  for (const B bone : {B::kHead, B::kNeck, B::kLeftUpperArm}) {
    const auto top = c.found.joint(bone);
    if (!top || !c.tree.is_below(*top, root)) continue;
    for (const JointIndex joint : c.tree.between(root, *top)) {
      if (off(joint) < max_offset && (!nearest || off(joint) < off(*nearest)))
        nearest = joint;
    }
  }
  return nearest;
}

void find_hips(Completion& c) {
  const auto joints = found_of(c.found,
                               {B::kLeftUpperLeg,
                                B::kRightUpperLeg,
                                B::kHead,
                                B::kNeck,
                                B::kLeftUpperArm,
                                B::kRightUpperArm});
  const JointIndex parting = c.tree.common(joints);
  const auto named = c.found.joint(B::kHips);
  if (named == parting || c.is_overridden(B::kHips)) return;
  if (glm::distance(c.tree.place(parting), mid_hip(c)) > half_leg(c)) {
    if (const auto hips = hips_of_spine(c, parting)) {
      c.remark("legs and spine separate at " + c.tree.quoted(parting) +
               ", far from the start of the legs; " + c.tree.quoted(*hips) +
               " is used as the hips, and the legs were moved below it");
      if (named != hips) c.set(B::kHips, *hips, BoneEvidence::kChain, 0.7);
      return;
    }
  }
  if (named) {
    c.remark(c.tree.quoted(*named) +
             " has the name of the hips, but legs and spine separate at " +
             c.tree.quoted(parting) + ", which is used");
  }
  c.set(B::kHips, parting, BoneEvidence::kChain, 0.85);
}

/// Returns the joint that carries both arms, if it belongs to the spine.
std::optional<JointIndex> arms_joint(const Completion& c) {
  const auto arms = found_of(c.found, {B::kLeftUpperArm, B::kRightUpperArm});
  const auto hips = c.found.joint(B::kHips);
  if (arms.size() < 2 || !hips) return std::nullopt;
  const JointIndex joint = c.tree.common(arms);
  if (!c.tree.is_below(joint, *hips)) return std::nullopt;
  return joint;
}

/// Returns the joints between hips and head, cut at the neck, which is found on the way.
std::vector<JointIndex> vertebrae(Completion& c) {
  const JointIndex hips = *c.found.joint(B::kHips);
  const auto head = c.found.joint(B::kHead);
  const auto arms = arms_joint(c);
  std::vector<JointIndex> way;
  if (head && c.tree.is_below(*head, hips)) {
    way = c.tree.between(hips, *head);
  } else if (arms) {
    way = c.tree.between(hips, *arms);
    way.push_back(*arms);
  }
  auto neck = c.found.joint(B::kNeck);
  auto at = neck ? std::ranges::find(way, *neck) : way.end();
  if (neck && at == way.end() && head) c.drop(B::kNeck);
  if (at == way.end() && arms) {
    at = std::ranges::find(way, *arms);
    // The neck is above the arms and below the head.
    if (at != way.end()) ++at;
    if (at != way.end()) c.set(B::kNeck, *at, BoneEvidence::kChain, 0.7);
  }
  way.erase(at, way.end());
  return way;
}

/// Assigns joints that have VRM's own words for the three bones of the spine. Returns
/// false if there are none.
bool named_spine(Completion& c, const std::vector<JointIndex>& chain) {
  struct Named {
    B bone;
    std::string_view word;
  };
  constexpr std::array<Named, 3> kNamed{
      {{B::kSpine, "spine"}, {B::kChest, "chest"}, {B::kUpperChest, "upperchest"}}};
  std::size_t next = 0;
  std::array<std::optional<JointIndex>, 3> joints;
  for (const JointIndex joint : chain) {
    for (std::size_t i = next; i < kNamed.size(); ++i) {
      if (c.word(joint) != kNamed[i].word) continue;
      joints[i] = joint;
      next = i + 1;
      break;
    }
  }
  if (!joints[0] || (chain.size() > 1 && !joints[1])) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (joints[i]) c.set(kNamed[i].bone, *joints[i], BoneEvidence::kName, 0.95);
  }
  return true;
}

/// Returns the inner one of four and more vertebrae that is nearest to a chest's height.
std::size_t chest_of(const Completion& c, const std::vector<JointIndex>& chain) {
  const auto neck = c.found.joint(B::kNeck);
  std::vector<double> height{c.tree.distance(*c.found.joint(B::kHips), chain[0])};
  for (std::size_t i = 1; i < chain.size(); ++i) {
    height.push_back(height.back() + c.tree.distance(chain[i - 1], chain[i]));
  }
  const double whole =
      height.back() + (neck ? c.tree.distance(chain.back(), *neck) : 0.0);
  std::size_t best = 1;
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
    const auto off = [&](std::size_t k) {
      return std::abs(height[k] - kChestHeight * whole);
    };
    if (off(i) < off(best)) best = i;
  }
  return best;
}

void find_spine(Completion& c) {
  const std::vector<JointIndex> chain = vertebrae(c);
  if (chain.empty() || named_spine(c, chain)) return;
  const auto vertebra = [&](B bone, std::size_t i) {
    const bool named = is_spine_word(c.word(chain[i]));
    c.set(bone,
          chain[i],
          named ? BoneEvidence::kName : BoneEvidence::kChain,
          named ? 0.9 : 0.8);
  };
  vertebra(B::kSpine, 0);
  if (chain.size() == 2) vertebra(B::kChest, 1);
  if (chain.size() < 3) return;
  vertebra(B::kChest, chain.size() == 3 ? 1 : chest_of(c, chain));
  vertebra(B::kUpperChest, chain.size() - 1);
}

void find_shoulders(Completion& c) {
  const auto arms = arms_joint(c);
  for (const B bone : {B::kLeftShoulder, B::kRightShoulder}) {
    const B arm_bone = bone == B::kLeftShoulder ? B::kLeftUpperArm : B::kRightUpperArm;
    const auto arm = c.found.joint(arm_bone);
    const auto named = c.found.joint(bone);
    if (!arm || c.is_overridden(bone)) continue;
    if (named && c.tree.is_below(*arm, *named)) continue;
    // The parent of an arm does not count if it is elsewhere in the tree; its name
    // decides.
    const auto hips = c.found.joint(B::kHips);
    if (named && hips && !c.tree.is_below(*arm, *hips)) continue;
    c.drop(bone);
    if (!arms || !c.tree.is_below(*arm, *arms)) continue;
    const std::vector<JointIndex> between = c.tree.between(*arms, *arm);
    if (!between.empty()) c.set(bone, between[0], BoneEvidence::kChain, 0.7);
  }
}

void find_toes(Completion& c) {
  for (const B bone : {B::kLeftToes, B::kRightToes}) {
    const B foot_bone = bone == B::kLeftToes ? B::kLeftFoot : B::kRightFoot;
    const B lower_bone = bone == B::kLeftToes ? B::kLeftLowerLeg : B::kRightLowerLeg;
    const auto foot = c.found.joint(foot_bone);
    const auto lower = c.found.joint(lower_bone);
    const auto named = c.found.joint(bone);
    if (!foot || !lower || c.is_overridden(bone)) continue;
    if (named && c.tree.is_below(*named, *foot)) continue;
    c.drop(bone);
    // A child nearer than a tenth of the shin is not a foot but a helper at the ankle.
    double furthest = 0.1 * c.tree.distance(*lower, *foot);
    std::optional<JointIndex> toes;
    for (const JointIndex child : c.tree.children(*foot)) {
      if (c.tree.distance(*foot, child) <= furthest) continue;
      furthest = c.tree.distance(*foot, child);
      toes = child;
    }
    if (toes) c.set(bone, *toes, BoneEvidence::kChain, 0.7);
  }
}

}  // namespace

void complete_bones(const SkeletonTree& tree,
                    const std::vector<JointWord>& words,
                    const BoneMap& overrides,
                    FoundBones& found) {
  Completion c{tree, words, overrides, found};
  find_ends(c);
  find_head(c);
  find_hips(c);
  find_spine(c);
  find_shoulders(c);
  find_toes(c);
}

}  // namespace marey::retarget
