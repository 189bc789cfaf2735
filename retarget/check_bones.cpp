// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "retarget/complete_bones.h"
#include "retarget/hang_bones.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kLeastAlikeLegs = 0.6;
constexpr std::string_view kRemedy =
    "say which joint it is in a bone map (marey inspect FILE --write-map begins one)";

Error bad_bones(std::string cause) {
  return bad_input("skeleton", std::move(cause), std::string(kRemedy));
}

bool is_foot(B bone) {
  return bone == B::kLeftFoot || bone == B::kRightFoot;
}

Status check_there(const BoneMap& told, const FoundBones& found) {
  std::string missing;
  for (const B bone : {B::kHips,
                       B::kLeftUpperLeg,
                       B::kLeftLowerLeg,
                       B::kLeftFoot,
                       B::kRightUpperLeg,
                       B::kRightLowerLeg,
                       B::kRightFoot}) {
    // A leg may end without a joint: hang_bones() makes one.
    const bool is_told_away = is_foot(bone) && told.bones[index(bone)].told;
    if (found.joint(bone) || is_told_away) continue;
    missing += (missing.empty() ? "" : ", ") + std::string(name(bone));
  }
  if (missing.empty()) return Done{};
  return bad_bones("no joint was found that is " + missing);
}

Status check_once(const SkeletonTree& tree, const FoundBones& found) {
  std::map<JointIndex, B> bones;
  for (const B bone : human_bones()) {
    const auto joint = found.joint(bone);
    if (!joint) continue;
    const auto [other, is_new] = bones.emplace(*joint, bone);
    if (is_new) continue;
    return bad_bones(tree.quoted(*joint) + " would be both " +
                     std::string(name(other->second)) + " and " +
                     std::string(name(bone)));
  }
  return Done{};
}

/// Bones that files hang elsewhere, on a root or a control: hang_bones() hangs them where
/// they belong. Shins and forearms are hung only when the user names them.
bool may_hang_elsewhere(const BoneMap& told, B bone) {
  const auto is_lower = [&](const HumanLimb& limb) { return limb.lower == bone; };
  const bool is_spine = bone == B::kSpine || bone == B::kChest || bone == B::kUpperChest;
  const bool is_middle = is_spine || std::ranges::any_of(human_limbs(), is_lower);
  return !is_middle || told.bones[index(bone)].told;
}

Status check_order(const SkeletonTree& tree,
                   const BoneMap& told,
                   const FoundBones& found) {
  for (const B bone : human_bones()) {
    const auto joint = found.joint(bone);
    const auto upper = joint ? carrier_of(found, bone) : std::nullopt;
    if (!upper) continue;
    const JointIndex carrier = *found.joint(*upper);
    if (tree.hangs_on(*joint, carrier)) continue;
    if (tree.hangs_on(carrier, *joint)) {
      return bad_bones(tree.quoted(*joint) + " would be " + std::string(name(bone)) +
                       " and carries " + tree.quoted(carrier) + ", the " +
                       std::string(name(*upper)));
    }
    if (may_hang_elsewhere(told, bone)) continue;
    return bad_bones(tree.quoted(*joint) + " would be " + std::string(name(bone)) +
                     " and does not hang on " + tree.quoted(carrier) + ", the " +
                     std::string(name(*upper)));
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
  if (std::min(left, right) > kLeastAlikeLegs * std::max(left, right)) return Done{};
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
                   const BoneMap& told,
                   const FoundBones& found) {
  if (const Status ok = check_there(told, found); !ok) return ok;
  if (const Status ok = check_once(tree, found); !ok) return ok;
  if (const Status ok = check_order(tree, told, found); !ok) return ok;
  return check_legs(tree, found);
}

}  // namespace marey::retarget
