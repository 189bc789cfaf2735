// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "retarget/complete_bones.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kLeastAlikeLegs = 0.6;
constexpr std::string_view kRemedy =
    "say which joint it is in a bone map (marey inspect FILE --write-map begins one)";

Error bad_bones(std::string cause) {
  return bad_input("skeleton", std::move(cause), std::string(kRemedy));
}

Status check_there(const FoundBones& found) {
  std::string missing;
  for (const B bone : {B::kHips,
                       B::kLeftUpperLeg,
                       B::kLeftLowerLeg,
                       B::kLeftFoot,
                       B::kRightUpperLeg,
                       B::kRightLowerLeg,
                       B::kRightFoot}) {
    if (found.joint(bone)) continue;
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

/// The nearest bone above that is found. Arms may hang on any vertebra.
std::optional<B> above(const FoundBones& found, B bone) {
  auto next = parent(bone);
  const bool leaves_spine =
      next == B::kUpperChest && bone != B::kNeck && bone != B::kUpperChest;
  if (leaves_spine) return B::kHips;
  while (next && !found.joint(*next)) {
    const bool left_the_arm = *next == B::kLeftShoulder || *next == B::kRightShoulder;
    next = left_the_arm ? std::optional(B::kHips) : parent(*next);
  }
  return next;
}

Status check_order(const SkeletonTree& tree, const FoundBones& found) {
  for (const B bone : human_bones()) {
    const auto joint = found.joint(bone);
    const auto upper = joint ? above(found, bone) : std::nullopt;
    if (!upper) continue;
    const JointIndex carrier = *found.joint(*upper);
    if (tree.hangs_on(*joint, carrier)) continue;
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

Status check_bones(const SkeletonTree& tree, const FoundBones& found) {
  if (const Status ok = check_there(found); !ok) return ok;
  if (const Status ok = check_once(tree, found); !ok) return ok;
  if (const Status ok = check_order(tree, found); !ok) return ok;
  return check_legs(tree, found);
}

}  // namespace marey::retarget
