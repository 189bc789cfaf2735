// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/bone_shape.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace marey::retarget {
namespace {

using B = HumanBone;

// From average_proportions().
constexpr double kLegRatio = 1.0;
constexpr double kArmRatio = 0.186 / 0.146;
// Minimum similarity of a left and a right side.
constexpr double kMinSimilarity = 0.8;
constexpr std::size_t kMaxPairs = 48;

/// Two branches of a joint that look like a left and a right limb.
struct BranchPair {
  JointIndex from{};
  std::array<JointIndex, 2> first{};
  std::array<LimbJoints, 2> limbs{};
  double alike = 0.0;  ///< 1: bone by bone of the same length.
  double reach = 0.0;  ///< Sum of both.
};

double ratio(double a, double b) {
  const double longer = std::max(a, b);
  return longer > 0.0 ? std::min(a, b) / longer : 0.0;
}

double alike(const SkeletonTree& tree, const LimbJoints& a, const LimbJoints& b) {
  return std::min(ratio(tree.distance(a.upper, a.lower), tree.distance(b.upper, b.lower)),
                  ratio(tree.distance(a.lower, a.end), tree.distance(b.lower, b.end)));
}

/// Returns the most similar pair of limbs that begin at children of a joint, the longest
/// if several are equal.
std::optional<BranchPair> best_pair(const SkeletonTree& tree,
                                    JointIndex from,
                                    double upper_over_lower) {
  struct Branch {
    JointIndex first;
    LimbJoints limb;
    double reach;
  };
  std::vector<Branch> branches;
  for (const JointIndex child : tree.children(from)) {
    const auto limb = limb_joints(tree, tree.longest_path(child), upper_over_lower);
    if (!limb) continue;
    const double reach =
        tree.distance(limb->upper, limb->lower) + tree.distance(limb->lower, limb->end);
    branches.push_back({child, *limb, reach});
  }
  std::ranges::stable_sort(branches, std::greater<>{}, &Branch::reach);
  std::optional<BranchPair> best;
  // Left and right are adjacent in length, or the spine is between them.
  for (std::size_t i = 0; i < branches.size() && i < 8; ++i) {
    for (std::size_t j = i + 1; j < branches.size() && j < i + 3; ++j) {
      const Branch& a = branches[i];
      const Branch& b = branches[j];
      const double likeness = alike(tree, a.limb, b.limb);
      if (likeness < kMinSimilarity) continue;
      const BranchPair pair{
          from, {a.first, b.first}, {a.limb, b.limb}, likeness, a.reach + b.reach};
      const double worth = likeness * pair.reach;
      if (!best || worth > best->alike * best->reach) best = pair;
    }
  }
  return best;
}

std::vector<BranchPair> best_pairs(const SkeletonTree& tree, double upper_over_lower) {
  std::vector<BranchPair> pairs;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const JointIndex joint{static_cast<int>(i)};
    if (tree.children(joint).size() < 2) continue;
    if (auto pair = best_pair(tree, joint, upper_over_lower)) pairs.push_back(*pair);
    // Longest first: fingers and hair of many strands are short.
    if (pairs.size() < 2 * kMaxPairs) continue;
    std::ranges::stable_sort(pairs, std::greater<>{}, &BranchPair::reach);
    pairs.resize(kMaxPairs);
  }
  std::ranges::stable_sort(pairs, std::greater<>{}, &BranchPair::reach);
  if (pairs.size() > kMaxPairs) pairs.resize(kMaxPairs);
  return pairs;
}

bool is_below(const SkeletonTree& tree, JointIndex joint, JointIndex above) {
  return joint == above || tree.is_below(joint, above);
}

bool is_apart(const SkeletonTree& tree, JointIndex joint, const BranchPair& pair) {
  return !is_below(tree, joint, pair.first[0]) && !is_below(tree, joint, pair.first[1]);
}

void add(FoundBones& found, B bone, JointIndex joint, double confidence) {
  found.bones[index(bone)] = FoundBone{joint, BoneEvidence::kShape, confidence};
}

void add_limbs(
    FoundBones& found, const BranchPair& pair, B left_upper, B left_lower, B left_end) {
  const double confidence = 0.75 * pair.alike;
  for (const B bone : {left_upper, left_lower, left_end}) {
    for (std::size_t side = 0; side < 2; ++side) {
      const LimbJoints& limb = pair.limbs[side];
      const JointIndex joint =
          bone == left_upper ? limb.upper : (bone == left_lower ? limb.lower : limb.end);
      add(found, side == 0 ? bone : mirrored(bone), joint, confidence);
    }
  }
}

}  // namespace

std::optional<LimbJoints> limb_joints(const SkeletonTree& tree,
                                      const std::vector<JointIndex>& way,
                                      double upper_over_lower) {
  // Fingers and toes are short, so the first ten joints contain the limb.
  const std::size_t count = std::min<std::size_t>(way.size(), 10);
  std::optional<LimbJoints> best;
  double best_score = 0.0;
  for (std::size_t i = 0; i + 2 < count; ++i) {
    for (std::size_t j = i + 1; j + 1 < count; ++j) {
      for (std::size_t k = j + 1; k < count; ++k) {
        const double upper = tree.distance(way[i], way[j]);
        const double lower = tree.distance(way[j], way[k]);
        if (!(upper > 0.0 && lower > 0.0)) continue;
        const double odd = std::abs(std::log(upper / lower / upper_over_lower));
        const double score = std::min(upper, lower) / (1.0 + odd);
        // Skips a joint only for a clearly better score.
        if (score <= 1.02 * best_score) continue;
        best_score = score;
        best = LimbJoints{way[i], way[j], way[k]};
      }
    }
  }
  return best;
}

std::optional<JointIndex> head_above(const SkeletonTree& tree,
                                     JointIndex chest,
                                     std::span<const JointIndex> arms) {
  std::optional<JointIndex> best;
  double furthest = 0.0;
  for (const JointIndex child : tree.children(chest)) {
    if (std::ranges::any_of(arms, [&](JointIndex arm) {
          return arm == child || tree.is_below(arm, child);
        })) {
      continue;
    }
    const double length = tree.distance(chest, child) + tree.reach(child);
    if (length <= furthest) continue;
    furthest = length;
    best = child;
  }
  if (!best) return std::nullopt;
  // Neck and head. Joints below a head (jaw, eyes, hair, its end) are many or short.
  JointIndex head = *best;
  if (tree.children(head).size() == 1) head = tree.children(head)[0];
  return head;
}

Result<FoundBones> shape_bones(const SkeletonTree& tree) {
  const std::vector<BranchPair> legs = best_pairs(tree, kLegRatio);
  const std::vector<BranchPair> arms = best_pairs(tree, kArmRatio);
  const BranchPair* best_legs = nullptr;
  const BranchPair* best_arms = nullptr;
  double best_score = 0.0;
  for (const BranchPair& lower : legs) {
    for (const BranchPair& upper : arms) {
      const bool fit =
          tree.is_below(upper.from, lower.from) && is_apart(tree, upper.from, lower);
      const double score = lower.alike * upper.alike * (lower.reach + upper.reach);
      if (!fit || score <= best_score) continue;
      best_score = score;
      best_legs = &lower;
      best_arms = &upper;
    }
  }
  if (best_legs == nullptr) {
    return bad_input("skeleton",
                     "no body was found among its " + std::to_string(tree.size()) +
                         " joints: no joint has two legs below it and two arms above",
                     "use a file with a skeleton, or set its bones in a bone map");
  }
  FoundBones found;
  found.scheme = "no names";
  const double both = 0.75 * best_legs->alike * best_arms->alike;
  add(found, B::kHips, best_legs->from, both);
  add_limbs(found, *best_legs, B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot);
  add_limbs(found, *best_arms, B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand);
  if (const auto head = head_above(tree, best_arms->from, best_arms->first)) {
    add(found, B::kHead, *head, 0.6 * best_arms->alike);
  } else {
    found.remarks.push_back("no head was found");
  }
  return found;
}

}  // namespace marey::retarget
