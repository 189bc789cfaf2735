// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/check_bones.h"

#include <algorithm>
#include <map>

#include "retarget/bones/reparent_bones.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kMinLegSimilarity = 0.6;
constexpr std::string_view kRemedy =
    "set the joint in a bone map (marey inspect FILE --write-map writes one)";

Error bad_bones(std::string cause) {
  return bad_input("skeleton", std::move(cause), std::string(kRemedy));
}

bool is_foot(B bone) {
  return bone == B::kLeftFoot || bone == B::kRightFoot;
}

Status check_there(const BoneMap& overrides, const FoundBones& found) {
  std::string missing;
  for (const B bone : {B::kHips,
                       B::kLeftUpperLeg,
                       B::kLeftLowerLeg,
                       B::kLeftFoot,
                       B::kRightUpperLeg,
                       B::kRightLowerLeg,
                       B::kRightFoot}) {
    // A leg may end without a joint: reparent_to_carriers() makes one.
    const bool is_declared_absent = is_foot(bone) && overrides.bones[index(bone)].is_set;
    if (found.joint(bone) || is_declared_absent) continue;
    missing += (missing.empty() ? "" : ", ") + std::string(name(bone));
  }
  if (missing.empty()) return Done{};
  return bad_bones("no joint was found for " + missing);
}

Status check_once(const SkeletonTree& tree, const FoundBones& found) {
  std::map<JointIndex, B> bones;
  for (const B bone : human_bones()) {
    const auto joint = found.joint(bone);
    if (!joint) continue;
    const auto [other, is_new] = bones.emplace(*joint, bone);
    if (is_new) continue;
    return bad_bones(tree.quoted(*joint) + " is identified as both " +
                     std::string(name(other->second)) + " and " +
                     std::string(name(bone)));
  }
  return Done{};
}

/// Returns true for bones that files place elsewhere, below a root or a control:
/// reparent_to_carriers() moves them. Shins and forearms are moved only if the user names
/// them.
bool may_hang_elsewhere(const BoneMap& overrides, B bone) {
  const auto is_lower = [&](const HumanLimb& limb) { return limb.lower == bone; };
  const bool is_spine = bone == B::kSpine || bone == B::kChest || bone == B::kUpperChest;
  const bool is_middle = is_spine || std::ranges::any_of(human_limbs(), is_lower);
  return !is_middle || overrides.bones[index(bone)].is_set;
}

Status check_order(const SkeletonTree& tree,
                   const BoneMap& overrides,
                   const FoundBones& found) {
  for (const B bone : human_bones()) {
    const auto joint = found.joint(bone);
    const auto upper = joint ? carrier_of(found, bone) : std::nullopt;
    if (!upper) continue;
    const JointIndex carrier = *found.joint(*upper);
    if (tree.is_below(*joint, carrier)) continue;
    if (tree.is_below(carrier, *joint)) {
      return bad_bones(tree.quoted(*joint) + " is identified as " +
                       std::string(name(bone)) + " but is above " + tree.quoted(carrier) +
                       ", the " + std::string(name(*upper)));
    }
    if (may_hang_elsewhere(overrides, bone)) continue;
    return bad_bones(tree.quoted(*joint) + " is identified as " +
                     std::string(name(bone)) + " but is not below " +
                     tree.quoted(carrier) + ", the " + std::string(name(*upper)));
  }
  return Done{};
}

double leg_length(const SkeletonTree& tree, const FoundBones& found, bool left) {
  const JointIndex upper = *found.joint(left ? B::kLeftUpperLeg : B::kRightUpperLeg);
  const JointIndex lower = *found.joint(left ? B::kLeftLowerLeg : B::kRightLowerLeg);
  const JointIndex foot = *found.joint(left ? B::kLeftFoot : B::kRightFoot);
  return tree.distance(upper, lower) + tree.distance(lower, foot);
}

Status check_legs(const SkeletonTree& tree, const FoundBones& found) {
  if (!found.joint(B::kLeftFoot) || !found.joint(B::kRightFoot)) return Done{};
  const double left = leg_length(tree, found, true);
  const double right = leg_length(tree, found, false);
  if (std::min(left, right) > kMinLegSimilarity * std::max(left, right)) return Done{};
  const bool left_is_short = left <= right;
  const JointIndex foot = *found.joint(left_is_short ? B::kLeftFoot : B::kRightFoot);
  const double longer = std::max(left, right);
  const int percent =
      longer > 0.0 ? static_cast<int>(100.0 * std::min(left, right) / longer) : 0;
  return bad_bones("the leg that ends at " + tree.quoted(foot) + " has only " +
                   std::to_string(percent) + " % of the other's length");
}

}  // namespace

Status check_bones(const SkeletonTree& tree,
                   const BoneMap& overrides,
                   const FoundBones& found) {
  if (const Status ok = check_there(overrides, found); !ok) return ok;
  if (const Status ok = check_once(tree, found); !ok) return ok;
  if (const Status ok = check_order(tree, overrides, found); !ok) return ok;
  return check_legs(tree, found);
}

}  // namespace marey::retarget
